#include "server/app/serve/ros_news.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/utf8.h"
#include "server/app/serve/clock_news.h"
#include "server/app/serve/operator_log.h"
#include "server/http/mark_order.h"

namespace kinescope::app {
namespace {

using ros_bridge::Diagnosis;

constexpr std::int64_t kDiagnoseEveryNanos = kNanosPerSecond;
constexpr std::size_t kMarksPerCall = 100;
constexpr std::int64_t kLostNanos = 5 * kNanosPerSecond;  // after the stream has become stale

std::string Percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", *share * 100) : "unknown";
}

// That at which the suit sends, Hz: what arrives and what is lost. 0: unknown.
double RateOfSuit(const SceneState* state, const StreamHealth& stream) {
  const double loss = stream.recent_loss.value_or(0);
  if (state == nullptr || state->liveness != Liveness::kLive || loss > 0.99) return 0;
  return state->rate_hz / (1 - loss);
}

Diagnosis DiagnosisOfStream(const SceneState* state, const StreamHealth& stream) {
  Diagnosis diagnosis;
  diagnosis.name = "stream";
  const bool is_live = state != nullptr && state->liveness == Liveness::kLive;
  if (is_live) {
    diagnosis.message = fmt::format("live, {:.1f} Hz", state->rate_hz);
  } else {
    diagnosis.level = Diagnosis::Level::kStale;
    diagnosis.message = state == nullptr ? "no data" : Name(state->liveness);
  }
  diagnosis.values = {{"samples", std::to_string(stream.samples)},
                      {"lost", std::to_string(stream.lost)},
                      {"lost or incomplete in 10 s", Percent(stream.recent_loss)},
                      {"gaps in 10 s", std::to_string(stream.gaps.recent)}};
  if (state != nullptr) {
    diagnosis.values.emplace_back("source", state->source);
    diagnosis.values.emplace_back("people", std::to_string(state->people.size()));
    for (const PersonState& person : state->people) {
      diagnosis.values.emplace_back(
          person.model->human.model_name,
          fmt::format("'{}', character {}", PrintableLine(person.name), person.character));
    }
  }
  return diagnosis;
}

Diagnosis DiagnosisOfClock(const NodeClock& clock) {
  Diagnosis diagnosis;
  diagnosis.name = "clock of " + PrintableLine(clock.node);
  diagnosis.message = ClockWarning(clock);
  if (!diagnosis.message.empty()) {
    diagnosis.level = Diagnosis::Level::kWarning;
  } else {
    diagnosis.message = clock.offset ? "as the server's" : "its stamps are of this time";
  }
  const auto add = [&](const char* name, double millis) {
    diagnosis.values.emplace_back(name, fmt::format("{:.1f}", millis));
  };
  if (clock.offset) {
    add("ahead of the server's, ms", 1e3 * Secs(clock.offset->nanos));
    add("uncertainty, ms", 1e3 * Secs(clock.offset->uncertainty_nanos));
  }
  if (const auto delay = DelayOf(clock)) {
    add("smallest delay, ms", delay->least_millis);
    add("largest delay, ms", delay->most_millis);
  } else {
    add("from stamp to arrival at least, ms", 1e3 * Secs(clock.least_lag_nanos));
  }
  add("added to its stamps, ms", 1e3 * Secs(clock.shift_nanos));
  return diagnosis;
}

// `shown`: by priority. The first one of the rule decides.
Diagnosis DiagnosisOfRule(const alarms::Rule& rule, const std::vector<alarms::Alarm>& shown) {
  Diagnosis diagnosis;
  diagnosis.name = "alarm " + rule.name;
  diagnosis.message = "no alarm";
  for (const alarms::Alarm& alarm : shown) {
    if (alarm.rule.name != rule.name) continue;
    if (diagnosis.level == Diagnosis::Level::kOk) {
      diagnosis.level = rule.priority == alarms::Priority::kHigh ? Diagnosis::Level::kError
                                                                 : Diagnosis::Level::kWarning;
      diagnosis.message = Describe(alarm);
    }
    const std::string whose = alarm.person.empty() ? "stream" : alarm.person;
    const char* const how = alarm.acknowledged ? "acknowledged" : alarm.is_on() ? "on" : "over";
    diagnosis.values.emplace_back(whose, fmt::format("{}: {}", how, Describe(alarm)));
  }
  return diagnosis;
}

ros_bridge::RosMark ForRos(const marks::Mark& mark) {
  ros_bridge::RosMark out;
  out.id = mark.id;
  out.revision = mark.revision;
  out.button = static_cast<std::uint8_t>(mark.button);
  out.text = mark.text;
  out.role = mark.role;
  out.stamp_nanos = mark.at.stamp_nanos;
  out.counter = mark.at.counter;
  if (mark.end) out.end_stamp_nanos = mark.end->stamp_nanos;
  out.is_open = mark.is_open;
  out.is_removed = mark.is_removed;
  return out;
}

ros_bridge::RosLogLine ForRos(const LogLine& line) {
  using Level = ros_bridge::RosLogLine::Level;
  const Level level = line.level <= spdlog::level::debug  ? Level::kDebug
                      : line.level == spdlog::level::info ? Level::kInfo
                      : line.level == spdlog::level::warn ? Level::kWarning
                                                          : Level::kError;
  return {level, line.text};
}

}  // namespace

std::vector<Diagnosis> DiagnosesOf(const SceneState* state, const StreamHealth& stream,
                                   const alarms::Alarms& alarms) {
  std::vector<Diagnosis> all = {DiagnosisOfStream(state, stream)};
  for (const NodeClock& clock : stream.clocks) all.push_back(DiagnosisOfClock(clock));
  const std::vector<alarms::Alarm> shown = alarms.shown();
  for (const alarms::Rule& rule : alarms.rules()) {
    all.push_back(DiagnosisOfRule(rule, shown));
  }
  return all;
}

RosNews::RosNews(ros_bridge::RosBridge& ros, const alarms::Alarms& alarms, marks::MarkBook* marks,
                 const Latest<SceneState>& states, std::shared_ptr<LogTail> log)
    : ros_(ros),
      alarms_(alarms),
      marks_(marks),
      states_(states),
      published_revision_(marks == nullptr ? 0 : marks->revision()),
      log_(std::move(log)) {}

void RosNews::OnTime(std::int64_t now_nanos, const StreamHealth& stream) {
  PublishMarks();
  PublishState(now_nanos);
  PublishLog();
  if (now_nanos - diagnosed_nanos_ < kDiagnoseEveryNanos && !is_due_) return;
  is_due_ = false;
  diagnosed_nanos_ = now_nanos;
  const auto state = states_.Get();
  ros_.PublishDiagnostics(DiagnosesOf(state.get(), stream, alarms_),
                          RateOfSuit(state.get(), stream));
}

void RosNews::PublishState(std::int64_t now_nanos) {
  const auto state = states_.Get();
  const Liveness liveness = state == nullptr ? Liveness::kNoData : state->liveness;
  if (liveness != Liveness::kStale) stale_since_ = 0;
  if (liveness == Liveness::kStale && stale_since_ == 0) stale_since_ = now_nanos;
  const bool is_lost = stale_since_ != 0 && now_nanos - stale_since_ >= kLostNanos;
  const std::string text = is_lost ? "lost" : Name(liveness);
  if (text != published_state_ && ros_.PublishState(text)) published_state_ = text;
}

void RosNews::PublishLog() {
  if (log_ == nullptr) return;
  for (LogLine& line : log_->Take()) {
    unheard_.push_back(std::move(line));
    if (unheard_.size() > LogTail::kMost) unheard_.pop_front();
  }
  while (!unheard_.empty() && ros_.PublishLog(ForRos(unheard_.front()))) unheard_.pop_front();
}

void RosNews::PublishMarks() {
  if (marks_ == nullptr || marks_->revision() == published_revision_) return;
  for (const marks::Mark& mark : marks_->ChangedAfter(published_revision_, kMarksPerCall)) {
    if (!ros_.PublishMark(ForRos(mark))) return;
    published_revision_ = mark.revision;
  }
}

void RosNews::OnMark(const std::string& text) {
  const auto state = states_.Get();
  const std::string line = PrintableLine(text);
  const std::size_t letters = DecodeUtf8(line).size();
  const bool is_button = line.size() == 1 && line[0] >= '1' && line[0] <= '9';
  const auto refuse = [&](const std::string& why) {
    const std::string told = refused_marks_.Pass("~mark was not kept: " + why, MonotonicNanos());
    if (!told.empty()) spdlog::warn("{}", told);
  };
  if (marks_ == nullptr)
    return refuse("marks need `kinescope serve` with a history (--history_minutes)");
  if (state == nullptr || state->stamp_nanos == 0) return refuse("no sample has come yet");
  if (line.find_first_not_of(' ') == std::string::npos) return refuse("its text is empty");
  if (letters > http::kLongestMark) {
    return refuse(fmt::format("{} characters are more than {}", letters, http::kLongestMark));
  }
  marks::NewMark mark;
  mark.button = is_button ? line[0] - '0' : 0;
  mark.text = line;
  mark.role = kRosRole;
  mark.at = {state->number, state->made_nanos, state->stamp_nanos, state->time_code_millis,
             state->counter};
  if (const auto kept = marks_->Add(mark); !kept) refuse(kept.error());
}

}  // namespace kinescope::app
