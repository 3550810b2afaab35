/// A trial of a study: one person, one condition, from start to stop. Values only; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinescope::recording {

/// A moment of the stream, as a mark has it.
struct TrialMoment {
  std::uint64_t state = 0;       // SceneState::number
  std::int64_t made_nanos = 0;   // SceneState::made_nanos; comparable within one run of the server
  std::int64_t stamp_nanos = 0;  // of the sample, ROS time
};

struct Trial {
  std::string stem;                 // of its files: "S07_lift_003"
  std::string person, condition;    // as typed
  int number = 1;                   // of this person in this condition
  std::int64_t run_micros = 0;      // when the server that has its moments was started, wall clock
  std::int64_t started_micros = 0;  // wall clock
  TrialMoment from;
  std::optional<TrialMoment> to;      // nullopt: it runs, or the server ended before it
  std::optional<std::uint64_t> mark;  // id of its span
  bool has_recording = false;         // stem + RawRecorder::kEnding
  std::string recording_problem;      // why there is none, or why it is not complete
  /// Of the person and the loads when it was started: values of the options of `kinescope loads`,
  /// "name=value", one per line.
  std::string options;
};

/// s, of one that has ended; 0 else.
double LengthSecs(const Trial& trial);

/// "S07 · lift · trial 3".
std::string TitleOf(const Trial& trial);

/// As a JSON object, indented: the content of stem.json.
std::string TrialText(const Trial& trial);

/// nullopt if `text` is no trial as TrialText() writes it.
std::optional<Trial> ReadTrial(std::string_view text);

}  // namespace kinescope::recording
