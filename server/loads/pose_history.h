/// The poses of the last tenths of a second, to be combined with motion that a filter has delayed.
/// One thread; no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "urdf/kinematics.h"

namespace kinescope::loads {

class PoseHistory {
 public:
  /// Adds the newest poses. A step back in time forgets the others; a repeated stamp replaces them.
  void Add(std::int64_t stamp_nanos, const urdf::LinkPoses& links);
  /// Between two samples interpolated; the oldest ones before them, the newest ones after them.
  /// @pre Add was called
  urdf::LinkPoses At(std::int64_t stamp_nanos) const;

 private:
  static constexpr std::size_t kMost = 64;
  struct Sample {
    std::int64_t stamp_nanos = 0;
    urdf::LinkPoses links{};
  };
  /// The `ago`th newest.
  const Sample& Newest(std::size_t ago) const { return ring_[(next_ + kMost - 1 - ago) % kMost]; }

  std::array<Sample, kMost> ring_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace kinescope::loads
