// The trials of the desk.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/json_text.h"
#include "server/app/serve/control_desk.h"
#include "server/app/serve/report_maker.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

recording::TrialMoment ToTrialMoment(const marks::Moment& moment) {
  return {moment.state, moment.made_nanos, moment.stamp_nanos};
}

}  // namespace

// Of this start of the server: moments of trials mean something within it.
std::int64_t ControlDesk::RunMicros() const {
  return parts_.marks != nullptr ? parts_.marks->run_micros() : start_micros_;
}

std::string ControlDesk::WhyNoTrial() const {
  return parts_.history == nullptr
             ? "no trials: this server keeps no former states (--history_minutes=0)"
             : "";
}

ControlDesk::Result ControlDesk::RunTrial(const http::TrialOrder& order, http::Role role) {
  const std::string why_not = WhyNoTrial();
  if (!why_not.empty()) return RefuseOrder(503, why_not);
  status_due_nanos_ = 0;
  switch (order.act) {
    case http::TrialOrder::Act::kStart: return StartTrial(order, role);
    case http::TrialOrder::Act::kStop: return StopTrial();
    case http::TrialOrder::Act::kMake: break;
  }
  return MakeOfTrial(order);
}

ControlDesk::Result ControlDesk::StartTrial(const http::TrialOrder& order, http::Role role) {
  if (running_) {
    return RefuseOrder(409, "a trial runs already: " + TitleOf(*running_) + "; stop it first");
  }
  if (log_.Now().state == 0) {
    return RefuseOrder(409, "no sample has come yet: a trial begins with one");
  }
  const std::string wrong = parts_.folder.Prepare();
  if (!wrong.empty()) return RefuseOrder(409, wrong);
  recording::Trial trial;
  trial.person = order.person;
  trial.condition = order.condition;
  trial.number = order.number;
  trial.stem = parts_.folder.FreeStem(
      fmt::format("{}_{}_{:03}", recording::NamePart(order.person, "person"),
                  recording::NamePart(order.condition, "condition"), order.number));
  trial.run_micros = RunMicros();
  trial.started_micros = WallNanos() / 1000;
  trial.options = ToLines(OptionsNow());
  if (parts_.recorder != nullptr) {
    const std::string problem = parts_.recorder->Start(trial.stem);
    if (!problem.empty()) return RefuseOrder(409, problem);
    trial.has_recording = true;
    was_recording_ = true;
  } else {
    trial.recording_problem = parts_.why_no_recording;
  }
  const marks::Moment now = log_.Now();  // the recording has it
  trial.from = ToTrialMoment(now);
  trial.mark = log_.BeginTrial(http::Name(role), TitleOf(trial), now);
  const std::string unwritten = trials_.Put(trial);
  if (!unwritten.empty()) {
    if (parts_.recorder != nullptr) parts_.recorder->Stop();
    return RefuseOrder(409, unwritten);
  }
  running_ = trial;
  ++files_revision_;
  return JsonText(json{{"trial", trial.stem}});
}

ControlDesk::Result ControlDesk::StopTrial() {
  if (!running_) return RefuseOrder(409, "no trial runs");
  recording::Trial trial = *std::exchange(running_, std::nullopt);
  const marks::Moment now = log_.Now();  // the recording has it
  if (trial.has_recording) {
    parts_.recorder->Stop();
    const auto status = parts_.recorder->status();
    trial.recording_problem = status.problem;
    if (status.dropped > 0) {
      trial.recording_problem =
          std::to_string(status.dropped) + " datagrams were not recorded: the disk was too slow";
    }
  }
  trial.to = ToTrialMoment(now);
  if (trial.mark) log_.EndTrial(*trial.mark, now);
  ++files_revision_;
  const std::string unwritten = trials_.Put(trial);
  if (!unwritten.empty())
    return RefuseOrder(409, "the trial was stopped, but not written: " + unwritten);
  return JsonText(json{{"trial", trial.stem}, {"secs", LengthSecs(trial)}});
}

ControlDesk::Result ControlDesk::MakeOfTrial(const http::TrialOrder& order) {
  const recording::Trial* const trial = trials_.Find(order.trial);
  if (trial == nullptr) return RefuseOrder(404, "no trial " + order.trial);
  if (running_ && running_->stem == trial->stem) {
    return RefuseOrder(409, "this trial runs; stop it first");
  }
  // What is possible is made, although the other is not.
  std::vector<std::string> refused;
  if (order.report) refused.push_back(AddTrialReport(*trial));
  if (order.clip) refused.push_back(AddTrialClip(*trial));
  const auto asked = refused.size();
  refused.erase(std::remove(refused.begin(), refused.end(), ""), refused.end());
  if (refused.size() == asked) return RefuseOrder(409, fmt::format("{}", fmt::join(refused, "; ")));
  return JsonText(json{{"trial", trial->stem}, {"refused", refused}});
}

// Those of the person and the loads, and the marks so far.
OptionTexts ControlDesk::ReportOptionsOf(const recording::Trial& trial) const {
  OptionTexts options = OptionsFromLines(trial.options);
  std::error_code ignored;
  if (parts_.marks != nullptr && std::filesystem::exists(parts_.marks->file(), ignored)) {
    SetOption(options, "marks", parts_.marks->file().string());
  }
  return options;
}

// "" or why not.
std::string ControlDesk::AddTrialClip(const recording::Trial& trial) {
  if (parts_.clips == nullptr) return parts_.why_no_clips;
  if (!trial.to || trial.run_micros != RunMicros()) return AddRecordedClip(trial);
  http::ClipOrder order;
  order.from_micros = trial.from.made_nanos / 1000;
  order.to_micros = trial.to->made_nanos / 1000;
  const auto span = SpanOf(order);
  if (!span) {
    const std::string wrong = AddRecordedClip(trial);
    return wrong.empty() ? "" : span.error().reason + "; " + wrong;
  }
  const auto added = AddClip(*span, camera_, TitleOf(trial), trial.stem + ".mp4");
  return added ? "" : added.error();
}

// Of one whose states are no longer here, as they are after another start. "" or why not.
std::string ControlDesk::AddRecordedClip(const recording::Trial& trial) {
  const auto recording = parts_.folder.Find(trial.stem + recording::RawRecorder::kEnding);
  if (!recording) return "no clip: there is neither a recording of this trial nor its states";
  std::string wrong = WhyNoRoom();
  if (!wrong.empty()) return wrong;
  OptionTexts options = ReportOptionsOf(trial);
  options.insert(options.end(), parts_.clip_options.begin(), parts_.clip_options.end());
  SetOption(options, "camera", camera_);
  SetOption(options, "title", TitleOf(trial));
  return AddOfRecording("clip", *recording, trial.stem + ".mp4", std::move(options),
                        MakeRecordedClip);
}

std::string ControlDesk::AddTrialReport(const recording::Trial& trial) {
  const auto recording = parts_.folder.Find(trial.stem + recording::RawRecorder::kEnding);
  if (!recording) {
    return "no report: there is no recording of this trial" +
           (trial.recording_problem.empty() ? std::string() : "; " + trial.recording_problem);
  }
  return AddOfRecording("report", *recording, trial.stem + ".html", ReportOptionsOf(trial),
                        MakeReport);
}

// What another command of this program makes of a recording. "" or why not.
std::string ControlDesk::AddOfRecording(const std::string& kind, const std::filesystem::path& from,
                                        const std::string& name, OptionTexts options,
                                        MakeOfRecording make) {
  const auto added =
      workshop_.Add(kind, name,
                    [this, from, to = parts_.folder.path() / name, options = std::move(options),
                     make](Workshop::Progress& progress) {
                      if (parts_.recorder != nullptr)
                        parts_.recorder->AwaitSaved(from.filename().string());
                      make(from, to, options, progress);
                    });
  return added ? "" : added.error();
}

}  // namespace kinescope::app
