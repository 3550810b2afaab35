/// Merges the time of a still and the times of the pictures of a clip, so that one pass over the
/// source makes both. A value; one thread.
#pragma once

#include <cstdint>
#include <optional>

#include "server/app/render/render_options.h"

namespace kinescope::app {

struct Moment {
  std::int64_t nanos = 0;       // after the first sample
  std::optional<long> picture;  // number in the clip; nullopt: the still
};

class Moments {
 public:
  Moments(std::optional<std::int64_t> still_nanos, std::optional<TimeGrid> clip)
      : still_nanos_(still_nanos), clip_(clip) {}

  /// The next one in order of time; of equal times the still comes first. nullopt after the last.
  std::optional<Moment> Next();

  /// The source ends before the clip does: no more of its pictures.
  void EndClip() { clip_.reset(); }

 private:
  std::optional<std::int64_t> still_nanos_;  // until it was returned
  std::optional<TimeGrid> clip_;             // until its end
  long next_picture_ = 0;
};

}  // namespace kinescope::app
