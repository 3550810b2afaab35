/// A recording that a server plays as if its suits sent it now. Such a stream is never called live.
#pragma once

#include <cstdint>
#include <optional>

namespace kinescope {

struct Playback {
  std::int64_t start_nanos = 0;  // stamp with which its first sample was played, ROS time
  /// After which it begins anew; nullopt: not known yet, or it does not.
  std::optional<std::int64_t> round_nanos;
  std::optional<std::int64_t>
      length_nanos;  // from the first sample to the last; nullopt: not known
  /// SceneState::made_nanos of its last sample; nullopt: it plays.
  std::optional<std::int64_t> ended_nanos;
};

inline bool operator==(const Playback& a, const Playback& b) {
  return a.start_nanos == b.start_nanos && a.round_nanos == b.round_nanos &&
         a.length_nanos == b.length_nanos && a.ended_nanos == b.ended_nanos;
}
inline bool operator!=(const Playback& a, const Playback& b) { return !(a == b); }

}  // namespace kinescope
