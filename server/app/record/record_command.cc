// `kinescope record`: the raw stream into a capture file, to be played, inspected or sent later.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/not_source.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/mvn/assembler.h"
#include "server/mvn/file/pcap_recorder.h"
#include "server/mvn/inspect/inspection.h"
#include "server/mvn/open.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMb = 1e6;
constexpr std::int64_t kStatusEveryNanos = 250'000'000;

struct RecordOptions {
  options::Text source, from, out;
  options::Number rotate_mb{0, {0, 1e9, "MB", false, "0: one file"}};
  options::Number seconds{0, {0, 1e9, "s", false, "0: until Ctrl-C or the end of the file"}};
  options::Flag force, json;

  void List(options::OptionList& option) {
    option("source", source, "udp://[address]:port, tcp://[address]:port, a capture or a .bin");
    option("from", from, "machines that may send, such as 192.168.1.20,10.0.0.0/8; not given: all");
    option("out", out,
           "file to write, .pcap or .pcapng; an existing one is replaced only with --force");
    option("rotate_mb", rotate_mb, "size at which the next file (take-0002.pcap) begins");
    option("seconds", seconds, "length of the recording");
    option("force", force, "replace the file, and the numbered ones of --rotate_mb");
    option("json", json, "print the summary as JSON");
  }
};

// Passes datagrams on to the recorder and looks into them on the way, for the people who watch.
class StreamStatistics : public mvn::DatagramSink, private SampleSink {
 public:
  explicit StreamStatistics(mvn::DatagramSink& next) : next_(next) {}

  void OnDatagram(const mvn::ReceivedDatagram& datagram) override {
    next_.OnDatagram(datagram);
    if (datagrams_++ == 0) first_nanos_ = datagram.arrival.monotonic_nanos;
    newest_nanos_ = datagram.arrival.monotonic_nanos;
    assembler_.Add(datagram.from, datagram.bytes, datagram.arrival, *this);
  }

  void Expire(std::int64_t now_nanos) { assembler_.Expire(now_nanos, *this); }
  void Flush() { assembler_.Flush(*this); }

  std::uint64_t datagrams() const { return datagrams_; }
  std::uint64_t samples() const { return samples_; }
  std::size_t people() const { return people_.size(); }
  std::uint64_t counter_gaps() const { return assembler_.counters().counter_gaps; }
  double seconds() const {  // of the stream
    return Secs(newest_nanos_ - first_nanos_);
  }

 private:
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override {
    ++samples_;
    people_.insert(sample.character);
  }

  mvn::DatagramSink& next_;
  mvn::Assembler assembler_{{mvn::Stamps::kFitted, mvn::Delivery::kPrompt}};
  std::uint64_t datagrams_ = 0;
  std::uint64_t samples_ = 0;
  std::set<int> people_;  // the assembler keeps at most 16 apart
  std::int64_t first_nanos_ = 0;
  std::int64_t newest_nanos_ = 0;
};

std::string LostText(const mvn::TransportCounters& transport,
                     const mvn::PcapRecorder::Counters& file) {
  std::string text;
  const auto add = [&text](std::uint64_t count, const char* where) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, where);
  };
  add(transport.kernel_drops, "by the kernel (receive buffer full)");
  add(file.dropped, "because the disk was too slow");
  add(file.too_long, "too long for a UDP packet");
  return text.empty() ? "nothing lost" : "lost: " + text;
}

// One line that is drawn again and again; only on a terminal.
class StatusLine {
 public:
  ~StatusLine() {
    if (drawn_) std::fputc('\n', stderr);
  }

  void Draw(std::int64_t now, const StreamStatistics& statistics,
            const mvn::TransportCounters& transport, const mvn::PcapRecorder& recorder) {
    if (!is_terminal_ || now - drawn_nanos_ < kStatusEveryNanos) return;
    const double secs = Secs(now - drawn_nanos_);
    const double datagrams = static_cast<double>(statistics.datagrams() - datagrams_) / secs;
    const double samples = static_cast<double>(statistics.samples() - samples_) / secs;
    drawn_nanos_ = now;
    datagrams_ = statistics.datagrams();
    samples_ = statistics.samples();
    const auto file = recorder.counters();
    const std::string line =
        fmt::format("{:.0f} datagrams/s, {}, {:.0f} samples/s, {}, {:.1f} MB", datagrams,
                    Counted(statistics.people(), "person", "people"), samples,
                    LostText(transport, file), static_cast<double>(file.bytes) / kBytesPerMb);
    fmt::print(stderr, "\r{:<100}", line);
    std::fflush(stderr);
    drawn_ = true;
  }

 private:
  const bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  bool drawn_ = false;
  std::int64_t drawn_nanos_ = MonotonicNanos();
  std::uint64_t datagrams_ = 0;  // when it was drawn last
  std::uint64_t samples_ = 0;    // when it was drawn last
};

void CheckRecordOptions(const RecordOptions& options) {
  constexpr double kMinMb = 0.1;
  if (*options.rotate_mb != 0 && *options.rotate_mb < kMinMb) {
    throw UsageError(fmt::format("--rotate_mb={}: expected 0 (one file) or {} to 1e9 MB",
                                 *options.rotate_mb, kMinMb));
  }
  const fs::path ending = fs::path(*options.out).extension();
  if (ending != ".pcap" && ending != ".pcapng") {
    throw UsageError("--out=" + *options.out + ": expected a name that ends in .pcap or .pcapng");
  }
  CheckIsNotSource(*options.source, *options.out, "--out=" + *options.out);
}

void Summarise(const RecordOptions& options, const StreamStatistics& statistics,
               const mvn::TransportCounters& transport, const mvn::PcapRecorder& recorder) {
  const auto file = recorder.counters();
  const std::string files = file.files.size() == 1
                                ? file.files.front()
                                : fmt::format("{} to {}", file.files.front(), file.files.back());
  const bool has_any = statistics.datagrams() > 0;
  if (has_any) {
    spdlog::info("recorded {} in {:.1f} s ({}, {}) to {}, {:.1f} MB; {}",
                 Counted(file.datagrams, "datagram"), statistics.seconds(),
                 Counted(statistics.samples(), "sample"),
                 Counted(statistics.people(), "person", "people"), files,
                 static_cast<double>(file.bytes) / kBytesPerMb, LostText(transport, file));
  }
  if (!*options.json) return;
  const nlohmann::ordered_json summary = {
      {"source", *options.source},
      {"files", has_any ? file.files : std::vector<std::string>()},
      {"bytes", file.bytes},
      {"datagrams", file.datagrams},
      {"samples", statistics.samples()},
      {"people", statistics.people()},
      {"stream_seconds", statistics.seconds()},
      {"counter_gaps", statistics.counter_gaps()},
      {"lost",
       {{"kernel", transport.kernel_drops}, {"disk", file.dropped}, {"too_long", file.too_long}}},
      {"receive_buffer_bytes", transport.receive_buffer_bytes},
      {"incomplete_packets", transport.incomplete_packets},
      {"other_packets", transport.other_packets},
  };
  Print("{}\n", JsonText(summary));
}

// A file without a packet would stand in the way of the next attempt.
void RemoveEmpty(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::symlink_status(file, ignored))) fs::remove(file, ignored);
  }
}

// Says what `inspect` would: where it listened, and what to check.
void ReportNothing(const mvn::DatagramSource& source, double secs) {
  const mvn::InspectionReport report = mvn::Inspection(source.is_live()).Report(source);
  const std::string waited = source.is_live() ? fmt::format(" within {:.1f} s", secs) : "";
  spdlog::error("nothing was recorded from {}{}, and no file is left: {}", source.description(),
                waited, fmt::join(report.advice, "; "));
}

// @return whether anything was recorded.
bool Record(const RecordOptions& options) {
  CheckRecordOptions(options);
  const auto source = mvn::OpenDatagrams(mvn::ReceivingFrom(*options.source, *options.from));
  if (source == nullptr) {
    throw SourceError(*options.source +
                      ": only MVN datagrams can be recorded; send this source with kinescope "
                      "stream and record the stream");
  }
  mvn::PcapWriterSettings settings;
  settings.path = *options.out;
  settings.rotate_bytes = static_cast<std::uint64_t>(*options.rotate_mb * kBytesPerMb);
  settings.force = *options.force;
  using WhenFull = mvn::PcapRecorder::WhenFull;
  mvn::PcapRecorder recorder(settings, source->is_live() ? WhenFull::kDrop : WhenFull::kWait);
  StreamStatistics statistics(recorder);
  spdlog::info("recording {} to {}", source->description(), *options.out);
  const std::int64_t start = MonotonicNanos();
  {
    StatusLine status;
    const auto is_over = [&](std::int64_t now) {
      if (*options.seconds <= 0) return false;
      const double live = Secs(now - start);
      return (source->is_live() ? live : statistics.seconds()) >= *options.seconds;
    };
    while (!StopRequested()) {
      const auto state = source->Poll(std::chrono::milliseconds(20), statistics);
      if (state == mvn::DatagramSource::State::kEnded) break;
      const std::int64_t now = MonotonicNanos();
      if (source->is_live() && state == mvn::DatagramSource::State::kIdle) statistics.Expire(now);
      recorder.Check();
      if (is_over(now)) break;
      status.Draw(now, statistics, source->counters(), recorder);
    }
  }
  statistics.Flush();
  recorder.Finish();
  Summarise(options, statistics, source->counters(), recorder);
  if (statistics.datagrams() > 0) return true;
  RemoveEmpty(recorder.counters().files);
  ReportNothing(*source, Secs(MonotonicNanos() - start));
  return false;
}

}  // namespace

Command RecordCommand() {
  const auto values = std::make_shared<RecordOptions>();
  Command command = CommandNamed("record");
  command.about +=
      "\nEach datagram becomes one UDP packet with its addresses and times, also when it came over "
      "TCP or from a file of raw datagrams.";
  values->List(command.options);
  command.positionals = {"source"};
  command.required = {"source", "out"};
  command.footer = "Exit code: 0 recorded, 1 nothing was received, 2 error.";
  command.run = [values](options::OptionList&) { return Record(*values) ? 0 : 1; };
  return command;
}

}  // namespace kinescope::app
