/// The marks of a motion in the order of its samples. A value; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/marks/mark.h"

namespace kinescope::marks {

/// By what marks and samples find each other.
enum class TrackClock {
  kServer,    // SceneState::made_nanos, within one run of a server
  kTimeCode,  // the suit's time code, which recordings keep
  kStamp,     // SceneState::stamp_nanos: ROS keeps stamps, and no time codes of the suit
};

struct TrackMark {
  std::int64_t from_nanos = 0;  // by the TrackClock
  std::int64_t to_nanos = 0;    // of a moment: from_nanos
  Mark mark;

  bool is_span() const { return mark.end.has_value(); }
};

class MarkTrack {
 public:
  MarkTrack() = default;
  /// `marks`: in the order of their changes; of each id the last one holds. Spans without an end
  /// are moments, and trials are left out: they are what is shown, not what is in it.
  MarkTrack(const std::vector<Mark>& marks, TrackClock clock);

  /// What a picture of `state` tells: spans that last, and moments for kWindowNanos after them.
  std::vector<const TrackMark*> At(const SceneState& state) const;
  /// Those from `first` to `last`, by time.
  std::vector<const TrackMark*> Between(const SceneState& first, const SceneState& last) const;
  /// From `state` to `nanos`, a time of a TrackMark, s; negative: before it.
  double SecsAfter(const SceneState& state, std::int64_t nanos) const;

  bool empty() const { return marks_.empty(); }

 private:
  template <class At>  // Moment, SceneState
  std::int64_t NanosOf(const At& at) const;

  TrackClock clock_ = TrackClock::kTimeCode;
  std::vector<TrackMark> marks_;  // from_nanos ascends
};

}  // namespace kinescope::marks
