#include "server/loads/velocity_fit.h"

#include "core/system/clocks.h"

namespace kinescope::loads {
namespace {

constexpr std::int64_t kWindowNanos = 100'000'000, kLeastSpanNanos = 40'000'000;

}  // namespace

void VelocityFit::Add(std::int64_t stamp_nanos, const Points& points) {
  if (size_ > 0 && stamp_nanos - At(size_ - 1).stamp_nanos <
                       kWindowNanos / static_cast<std::int64_t>(kMost - 1)) {
    return;
  }
  // Two samples stay, however far apart, so that slow streams have a velocity.
  while (size_ == kMost || (size_ >= 2 && stamp_nanos - At(0).stamp_nanos > kWindowNanos)) {
    first_ = (first_ + 1) % kMost;
    --size_;
  }
  ring_[(first_ + size_) % kMost] = {stamp_nanos, points};
  ++size_;
}

std::optional<Eigen::Vector3d> VelocityFit::Of(std::size_t point) const {
  if (size_ < 2 || At(size_ - 1).stamp_nanos - At(0).stamp_nanos < kLeastSpanNanos) {
    return std::nullopt;
  }
  const std::int64_t begin = At(0).stamp_nanos;
  double mean_secs = 0;
  for (std::size_t i = 0; i < size_; ++i) mean_secs += Secs(At(i).stamp_nanos - begin);
  mean_secs /= static_cast<double>(size_);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    const double secs = Secs(At(i).stamp_nanos - begin) - mean_secs;
    sum += secs * At(i).points[point];
    squares += secs * secs;
  }
  return Eigen::Vector3d(sum / squares);
}

}  // namespace kinescope::loads
