#include "server/loads/pose_history.h"

#include <algorithm>

namespace kinescope::loads {

void PoseHistory::Add(std::int64_t stamp_nanos, const urdf::LinkPoses& links) {
  if (size_ > 0 && stamp_nanos < Newest(0).stamp_nanos) size_ = 0;
  if (size_ > 0 && stamp_nanos == Newest(0).stamp_nanos) {
    next_ = (next_ + kMost - 1) % kMost;
    --size_;
  }
  ring_[next_] = {stamp_nanos, links};
  next_ = (next_ + 1) % kMost;
  size_ = std::min(size_ + 1, kMost);
}

urdf::LinkPoses PoseHistory::At(std::int64_t stamp_nanos) const {
  std::size_t ago = 0;
  while (ago + 1 < size_ && Newest(ago).stamp_nanos > stamp_nanos) ++ago;
  const Sample& before = Newest(ago);
  if (ago == 0 || before.stamp_nanos >= stamp_nanos) return before.links;
  const Sample& after = Newest(ago - 1);
  const double share = static_cast<double>(stamp_nanos - before.stamp_nanos) /
                       static_cast<double>(after.stamp_nanos - before.stamp_nanos);
  return urdf::Interpolate(before.links, after.links, share);
}

}  // namespace kinescope::loads
