/// Joins the datagrams of type 13 (first the segments, then points in several parts) to what they
/// describe: a body with its gloves and props, or a cluster of tracked objects. Untrusted: what is
/// kept is bounded. One thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/body_sample.h"
#include "server/mvn/datagram.h"
#include "urdf/skeleton.h"

namespace kinescope::mvn {

class ScaleGroup {
 public:
  /// Takes one part. Nothing, or why it is not used. Afterwards ask Take().
  std::optional<Reason> Add(const Header& header, const ScaleMessage& part, std::int64_t now_nanos);

  struct Scale {
    std::optional<urdf::Skeleton> skeleton;  // none: objects
    std::vector<ScaledSegment> extra;        // as in Character
  };

  /// What was described, once per group: when all its parts came, or when no further part came for
  /// half a second (a part was lost; landmarks that are missing are estimated).
  std::optional<Scale> Take(std::int64_t now_nanos);

  /// When Take() may have something without a further part; nullopt: nothing is waiting.
  std::optional<std::int64_t> deadline_nanos() const;

 private:
  using Origins = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

  struct Segments {
    std::optional<Origins> body;
    std::vector<ScaledSegment> extra;
  };

  static std::optional<Reason> Read(const ScaleMessage& part, Segments& segments);
  bool IsWhole() const;

  std::optional<Segments> segments_;
  urdf::Landmarks landmarks_;
  std::bitset<128> parts_;
  std::optional<int> last_part_;
  bool taken_ = false;
  std::int64_t last_part_nanos_ = 0;
};

}  // namespace kinescope::mvn
