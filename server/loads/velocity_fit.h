/// Velocities of points from their positions: the slope of a straight line fitted by least squares
/// through the last tenth of a second. Differences of neighbours amplify noise: 1 mm at 240 Hz is
/// 0.34 m/s between neighbours, 0.007 m/s along the line (biomech-files.md B.7). The velocity is
/// that of 0.05 s ago. One thread; no allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinescope::loads {

class VelocityFit {
 public:
  static constexpr std::size_t kPoints = 6;
  using Points = std::array<Eigen::Vector3d, kPoints>;  // world, m

  void Restart() { size_ = 0; }
  /// Stamps rise. Positions that follow within a 63rd of the window are left out.
  void Add(std::int64_t stamp_nanos, const Points& points);
  /// m/s; absent until the positions span 0.04 s.
  std::optional<Eigen::Vector3d> Of(std::size_t point) const;

 private:
  static constexpr std::size_t kMost = 64;
  struct Sample {
    std::int64_t stamp_nanos = 0;
    Points points;
  };
  const Sample& At(std::size_t index) const { return ring_[(first_ + index) % kMost]; }

  std::array<Sample, kMost> ring_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace kinescope::loads
