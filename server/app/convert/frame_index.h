/// Numbers the samples of one person as frames of a file with a constant rate, and finds holes. One
/// thread.
#pragma once

#include <cstdint>
#include <optional>

#include "core/body_sample.h"

namespace kinescope::app {

class FrameIndex {
 public:
  struct Hole {
    double from_secs = 0, secs = 0;
    std::uint64_t frames = 0;
  };

  /// `rate_hz`: frames per second. `step`: of the counters per frame; a fraction if steps
  /// alternate.
  FrameIndex(double rate_hz, double step) : rate_hz_(rate_hz), step_(step) {}

  /// The frame of the next sample, from 0, larger than the one before: by its counter, and by its
  /// stamp where the counter starts over.
  std::int64_t Next(const BodySample& sample);

  std::uint64_t missing_frames() const { return missing_frames_; }
  std::uint64_t holes() const { return holes_; }
  const std::optional<Hole>& longest_hole() const { return longest_; }

 private:
  const double rate_hz_;
  const double step_;
  std::optional<std::int64_t> index_;
  std::int64_t first_stamp_ = 0, last_stamp_ = 0;
  std::uint32_t last_counter_ = 0;
  std::uint64_t missing_frames_ = 0, holes_ = 0;
  std::optional<Hole> longest_;
};

}  // namespace kinescope::app
