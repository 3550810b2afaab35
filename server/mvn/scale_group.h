/// Assembles the datagrams of type 13 (first the segments, then points in several parts) to a
/// description of a body with its gloves and props, or of a group of tracked objects. The input is
/// untrusted: memory is limited. One thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/body_sample.h"
#include "server/mvn/datagram.h"
#include "urdf/landmarks.h"

namespace kinescope::mvn {

class ScaleGroup {
 public:
  /// Adds one part. Returns nullopt, or why it was rejected. Call Take() afterwards.
  std::optional<Reason> Add(const Header& header, const ScaleMessage& part, std::int64_t now_nanos);

  struct Scale {
    std::optional<urdf::Skeleton> skeleton;      // absent: objects
    urdf::Landmarks landmarks;                   // of the skeleton, as received
    std::vector<ScaledSegment> scaled_segments;  // as in Character
  };

  /// Returns the description once per group: when all parts are received, or when no part was
  /// received for half a second (a part was lost; missing landmarks are then estimated).
  std::optional<Scale> Take(std::int64_t now_nanos);

  /// When Take() may succeed without a further part (monotonic clock, ns); nullopt: nothing waits.
  std::optional<std::int64_t> deadline_nanos() const;

 private:
  using Origins = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

  struct Segments {
    std::optional<Origins> body;
    std::vector<ScaledSegment> scaled_segments;
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
