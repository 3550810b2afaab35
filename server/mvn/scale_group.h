/// Joins the datagrams of type 13 (first the segments, then points in several parts) to a skeleton.
/// Untrusted: what is kept is bounded. One thread.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>

#include "server/mvn/datagram.h"
#include "urdf/skeleton.h"

namespace kinescope::mvn {

class ScaleGroup {
 public:
  /// Takes one part. Nothing, or why it is not used. Afterwards ask TakeSkeleton().
  std::optional<Reason> Add(const Header& header, const ScaleMessage& part, std::int64_t now_nanos);

  /// The skeleton, once per group: when all its parts came, or when no further part came for half a
  /// second (a part was lost; landmarks that are missing are estimated).
  std::optional<urdf::Skeleton> TakeSkeleton(std::int64_t now_nanos);

  /// When TakeSkeleton() may have something without a further part; nullopt: nothing is waiting.
  std::optional<std::int64_t> deadline_nanos() const;

 private:
  using Origins = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

  bool IsWhole() const;

  std::optional<Origins> origins_;
  urdf::Landmarks landmarks_;
  std::bitset<128> parts_;
  std::optional<int> last_part_;
  bool taken_ = false;
  std::int64_t last_part_nanos_ = 0;
};

}  // namespace kinescope::mvn
