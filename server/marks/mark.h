/// A mark: a moment or a span of the stream that got a name. Values only; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace kinescope::marks {

/// The sample on the screen of the person who set the mark.
struct Moment {
  std::uint64_t state = 0;       // SceneState::number
  std::int64_t made_nanos = 0;   // SceneState::made_nanos; comparable within one run of the server
  std::int64_t stamp_nanos = 0;  // of the sample, ROS time
  std::int64_t time_code_millis = 0;
  std::uint32_t counter = 0;
};

/// What a mark is of.
enum class Kind {
  kMark,    // what a person saw
  kChange,  // what an operator changed, with the old and the new value
  kTrial,   // a trial, from start to stop
};

struct Mark {
  std::uint64_t id = 0;         // from 1, within its file
  std::uint64_t revision = 0;   // of the book when the mark was last changed
  std::int64_t run_micros = 0;  // when the server that has its moments was started, wall clock
  Kind kind = Kind::kMark;
  int button = 0;  // 1 to 9; 0: free text
  std::string text;
  std::string role;  // of the author: "operator"
  Moment at;
  std::optional<Moment> end;  // of a span; not before `at`
  bool is_open = false;       // a span whose end has not been set
  bool is_removed = false;
  double behind_secs = 0;          // by which its author looked back
  std::int64_t pressed_nanos = 0;  // wall clock
};

/// The time that belongs to a mark: of a span, the span; else kWindowNanos before and after it.
inline constexpr std::int64_t kWindowNanos = 3'000'000'000;

}  // namespace kinescope::marks
