// `kinescope inspect`: what is in a stream or a file.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/stop_signal.h"
#include "server/app/commands.h"
#include "server/app/inspect/floor_seeker.h"
#include "server/app/inspect/inspection_report.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/inspect/inspection.h"
#include "server/mvn/open.h"
#include "server/options/ros_names.h"
#include "server/ros/source/bag_source.h"
#include "server/source/open_source.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

struct InspectOptions {
  options::Text source, from;
  options::Number seconds{kInspectSecs, {0, 86'400, "s", true}};
  options::Flag json;
  options::Text tf_topic{"", kTopicNameExpected, IsTopicNameOrEmpty};

  void List(options::OptionList& option) {
    option("source", source, "stream or recording to examine: " + SourceKinds());
    option("from", from, "machines that may send, such as 192.168.1.20,10.0.0.0/8; not given: all");
    option("seconds", seconds, "time to listen to a live stream");
    option("tf_topic", tf_topic, kTfTopicHelp);
    option("json", json, "print the result as JSON (docs/inspect.md)");
  }
};

// How long waiting may take: what decides how soon Ctrl-C is noticed.
constexpr std::chrono::milliseconds kInspectPollTimeout(20);
constexpr std::int64_t kDrainNanos = 200'000'000;

// Hands datagrams on; of a file, also to the search for the floor and to the progress.
class DatagramSteps : public mvn::DatagramSink {
 public:
  DatagramSteps(mvn::Inspection& to, FloorSeeker* floors, Progress* progress)
      : to_(to), floors_(floors), progress_(progress) {}
  void OnDatagram(const mvn::ReceivedDatagram& datagram) override {
    to_.OnDatagram(datagram);
    if (floors_ != nullptr) floors_->OnDatagram(datagram);
    if (progress_ != nullptr) progress_->Step();
  }

 private:
  mvn::Inspection& to_;
  FloorSeeker* floors_;
  Progress* progress_;
};

mvn::InspectionReport InspectDatagrams(mvn::DatagramSource& source, double seconds) {
  mvn::Inspection inspection(source.is_live());
  std::unique_ptr<Progress> progress;
  std::unique_ptr<FloorSeeker> floors;
  std::int64_t end = 0;
  if (source.is_live()) {
    spdlog::info("listening at {} for {:g} s; press Ctrl-C to stop earlier", source.description(),
                 seconds);
    end = MonotonicNanos() + static_cast<std::int64_t>(seconds * 1e9);
  } else {
    progress = std::make_unique<Progress>("datagrams", 0);
    floors = std::make_unique<FloorSeeker>();
  }
  DatagramSteps steps(inspection, floors.get(), progress.get());
  while (!StopRequested() && (end == 0 || MonotonicNanos() < end)) {
    const auto state = source.Poll(kInspectPollTimeout, steps);
    if (state == mvn::DatagramSource::State::kEnded) break;
    if (source.is_live() && state == mvn::DatagramSource::State::kIdle) {
      inspection.Expire(MonotonicNanos());
    }
  }
  // What came in time but was not read yet still counts; a stream that never pauses does not hold
  // us up.
  const std::int64_t patience = MonotonicNanos() + kDrainNanos;
  for (int idle = 0; source.is_live() && idle < 2 && MonotonicNanos() < patience;) {
    const auto state = source.Poll(std::chrono::milliseconds(0), steps);
    if (state != mvn::DatagramSource::State::kMore) ++idle;  // the first may be a new connection
  }
  mvn::InspectionReport report = inspection.Report(source);
  if (floors != nullptr) floors->Fill(report);
  return report;
}

// Likewise for samples.
class SampleSteps : public SampleSink {
 public:
  explicit SampleSteps(FloorSeeker* floors) : floors_(floors) {}

  void OnCharacter(const Character& character) override {
    inspection_.OnCharacter(character);
    if (floors_ != nullptr) floors_->OnCharacter(character);
  }
  void OnSample(const BodySample& sample) override {
    inspection_.OnSample(sample);
    if (floors_ != nullptr) floors_->OnSample(sample);
    progress_.Step();
    ++samples_;
  }
  void OnObjects(const ObjectsSample& sample) override { inspection_.OnObjects(sample); }

  double samples() const { return samples_; }
  const mvn::SampleInspection& inspection() const { return inspection_; }

 private:
  FloorSeeker* floors_;
  mvn::SampleInspection inspection_;
  Progress progress_{"samples", 0};
  double samples_ = 0;
};

// The built-in subject never ends: `seconds` of it will do, as of a live source. A file is read to
// its end.
mvn::InspectionReport InspectSamples(Source& source, double seconds, bool has_end) {
  std::unique_ptr<FloorSeeker> floors;
  if (has_end) floors = std::make_unique<FloorSeeker>();
  SampleSteps steps(floors.get());
  if (source.is_live()) {
    spdlog::info("receiving from {} for {:g} s; press Ctrl-C to stop earlier", source.description(),
                 seconds);
    const std::int64_t end = MonotonicNanos() + static_cast<std::int64_t>(seconds * 1e9);
    while (!StopRequested() && MonotonicNanos() < end) {
      if (source.Poll(kInspectPollTimeout, steps) == Source::State::kEnded) break;
    }
    return steps.inspection().Report(source);
  }
  const double most = seconds * source.nominal_rate_hz();
  while (!StopRequested() && (has_end || steps.samples() < most)) {
    if (source.Poll(kInspectPollTimeout, steps) == Source::State::kEnded) break;
  }
  mvn::InspectionReport report = steps.inspection().Report(source);
  if (floors != nullptr) floors->Fill(report);
  return report;
}

// "MVNX version 4": the version as the first tag says it.
std::string MvnxFormat(std::string_view head) {
  const std::size_t tag = head.find("<mvnx");
  const std::string_view in_tag =
      tag == head.npos ? "" : head.substr(tag, head.find('>', tag) - tag);
  const std::size_t at = in_tag.find(" version=");
  const std::size_t digit = at + std::string_view(" version='").size();
  if (at == in_tag.npos || digit >= in_tag.size()) return "MVNX";
  return std::string("MVNX version ") + in_tag[digit];
}

void CheckNeedsNoBag(const InspectOptions& options) {
  if (options.tf_topic->empty()) return;
  throw UsageError("--tf_topic=" + *options.tf_topic + ": '" + *options.source +
                   "' is no ROS bag; of a ROS graph, name the topic in the source: ros:/human/tf");
}

// A file is opened once only: it may be a pipe.
mvn::InspectionReport InspectFile(const InspectOptions& options) {
  InputFile file = OpenInputFile(*options.source);
  const std::string name = NameOfInput(*options.source);
  const mvn::RecordingKind kind = mvn::KindOf(file.head());
  if (kind != mvn::RecordingKind::kRosBag) CheckNeedsNoBag(options);
  mvn::InspectionReport report;
  switch (kind) {
    case mvn::RecordingKind::kPcap:
    case mvn::RecordingKind::kDatagrams:
      report = InspectDatagrams(*mvn::OpenRecording(std::move(file), name), *options.seconds);
      report.format = kind == mvn::RecordingKind::kPcap ? "capture" : "MVN datagrams";
      return report;
    case mvn::RecordingKind::kMvnx: {
      const std::string format = MvnxFormat(file.head());
      mvn::MvnxSource source(std::move(file), name);
      report = InspectSamples(source, *options.seconds, true);
      report.format = format;
      return report;
    }
    case mvn::RecordingKind::kRosBag:
      if (*options.source != "-") {
        GraphView view;
        view.tf_topic = *options.tf_topic;
        view.needs_person = false;
        report =
            InspectSamples(*ros_bridge::OpenBag(*options.source, view), *options.seconds, true);
        report.format = "ROS 1 bag";
        return report;
      }
      throw SourceError("a ROS bag cannot be read from a pipe; save it to a file first");
    case mvn::RecordingKind::kEmpty:
    case mvn::RecordingKind::kUnknown: break;
  }
  throw SourceError(mvn::DescribeUnfit(*options.source, file.head(), SourceKinds()));
}

mvn::InspectionReport Inspect(const InspectOptions& options) {
  mvn::InspectionReport report;
  if (KindOfSource(*options.source) != SourceKind::kFile) CheckNeedsNoBag(options);
  switch (KindOfSource(*options.source)) {
    case SourceKind::kUdp:
    case SourceKind::kTcp:
      report =
          InspectDatagrams(*mvn::OpenDatagrams(mvn::ReceivingFrom(*options.source, *options.from)),
                           *options.seconds);
      report.format = KindOfSource(*options.source) == SourceKind::kUdp ? "UDP" : "TCP";
      break;
    case SourceKind::kSubject:
      report = InspectSamples(*OpenSource(*options.source), *options.seconds, false);
      report.format = "built-in subject";
      break;
    case SourceKind::kPose:
      report = InspectSamples(*OpenSource(*options.source), *options.seconds, false);
      report.format = "written pose";
      break;
    case SourceKind::kGraph: {
      const std::unique_ptr<Source> source = OpenSource(*options.source);
      report = InspectSamples(*source, *options.seconds, false);
      report.format = "ROS graph";
      if (report.CanBeShown()) break;
      const std::string missing = HindranceOf(*options.source, *source).text;
      if (!missing.empty()) report.advice.push_back(missing);
      break;
    }
    case SourceKind::kFile: report = InspectFile(options); break;
  }
  return report;
}

bool RunInspect(const InspectOptions& options) {
  const mvn::InspectionReport report = Inspect(options);
  PrintText(stdout, *options.json ? ReportJson(report) : ReportText(report));
  return report.CanBeShown();
}

}  // namespace

Command InspectCommand() {
  const auto values = std::make_shared<InspectOptions>();
  Command command = CommandNamed("inspect");
  command.shows_progress = true;
  values->List(command.options);
  command.positionals = {"source"};
  command.required = {"source"};
  command.footer = "Exit code: 0 a person can be shown, 1 no person can be shown, 2 error.";
  command.run = [values](options::OptionList&) { return RunInspect(*values) ? 0 : 1; };
  return command;
}

}  // namespace kinescope::app
