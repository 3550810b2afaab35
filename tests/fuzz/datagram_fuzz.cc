// Any bytes as one datagram: refused with a place inside it, or accepted and written again as a
// datagram that means the same.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "core/system/check.h"
#include "server/mvn/encode.h"

namespace datagram_fuzz {
namespace {

using namespace kinescope::mvn;

// What the stream's floats leave of a number that was converted, or of a turn.
bool IsNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).norm() <= 1e-6 * (1 + a.norm());
}
bool IsNear(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b) < 1e-5;
}

void CheckSameItem(const PoseItem& a, const PoseItem& b) {
  KINESCOPE_CHECK(IsNear(a.position, b.position) && IsNear(a.orientation, b.orientation));
}
void CheckSameItem(const LinearItem& a, const LinearItem& b) {
  KINESCOPE_CHECK(a.position == b.position && a.velocity == b.velocity &&
                  a.acceleration == b.acceleration);
}
void CheckSameItem(const AngularItem& a, const AngularItem& b) {
  KINESCOPE_CHECK(IsNear(a.orientation, b.orientation) && a.velocity == b.velocity &&
                  a.acceleration == b.acceleration);
}

// Whether `again` says what the message does that it was written from.
struct SameBody {
  const Body& again;

  template <class Content>
  const Content& Other(const Content&) const {
    return std::get<Content>(again);
  }

  template <class Item>
  void CheckSegments(const PerSegment<Item>& body, const PerSegment<Item>& other) const {
    KINESCOPE_CHECK(body.present == other.present);
    for (std::size_t i = 0; i < body.items.size(); ++i) {
      if (body.present.test(i)) CheckSameItem(body.items[i], other.items[i]);
    }
  }

  void operator()(const PoseMessage& body) const { CheckSegments(body, Other(body)); }
  void operator()(const EulerPoseMessage& body) const { CheckSegments(body, Other(body)); }
  void operator()(const LinearMessage& body) const { CheckSegments(body, Other(body)); }
  void operator()(const AngularMessage& body) const { CheckSegments(body, Other(body)); }

  void operator()(const MarkersMessage& body) const {
    const MarkersMessage& other = Other(body);
    KINESCOPE_CHECK(body.count == other.count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(body.count); ++i) {
      const MarkerItem &a = body.markers[i], &b = other.markers[i];
      KINESCOPE_CHECK(a.segment_id == b.segment_id && a.point_id == b.point_id);
      KINESCOPE_CHECK(IsNear(a.position, b.position));
    }
  }

  void operator()(const JointAnglesMessage& body) const {
    const JointAnglesMessage& other = Other(body);
    KINESCOPE_CHECK(body.joints_present == other.joints_present);
    KINESCOPE_CHECK(body.ergonomic_present == other.ergonomic_present);
    KINESCOPE_CHECK(body.joints == other.joints && body.ergonomic == other.ergonomic);
  }

  void operator()(const TrackersMessage& body) const {
    const TrackersMessage& other = Other(body);
    KINESCOPE_CHECK(body.present == other.present);
    for (std::size_t i = 0; i < body.trackers.size(); ++i) {
      if (!body.present.test(i)) continue;
      const kinescope::TrackerState &a = body.trackers[i], &b = other.trackers[i];
      KINESCOPE_CHECK(IsNear(a.orientation, b.orientation) && a.has_rates == b.has_rates);
      KINESCOPE_CHECK(
          a.free_acceleration == b.free_acceleration && a.acceleration == b.acceleration &&
          a.angular_velocity == b.angular_velocity && a.magnetic_field == b.magnetic_field);
    }
  }

  void operator()(const CenterOfMassMessage& body) const {
    const CenterOfMassMessage& other = Other(body);
    KINESCOPE_CHECK(body.position == other.position && body.velocity == other.velocity &&
                    body.acceleration == other.acceleration &&
                    body.has_derivatives == other.has_derivatives);
  }

  void operator()(const TimeCodeMessage& body) const {
    KINESCOPE_CHECK(body.utc_millis_of_day == Other(body).utc_millis_of_day);
  }

  void operator()(const MetaDataMessage& body) const {
    KINESCOPE_CHECK(body.name == Other(body).name && body.color_rgb == Other(body).color_rgb);
  }

  void operator()(const ScaleMessage& body) const {
    const ScaleMessage& other = Other(body);
    KINESCOPE_CHECK(body.segments.size() == other.segments.size());
    KINESCOPE_CHECK(body.points.size() == other.points.size());
    for (std::size_t i = 0; i < body.segments.size(); ++i) {
      KINESCOPE_CHECK(body.segments[i].name == other.segments[i].name);
    }
  }
};

void CheckSameHeader(const Header& a, const Header& b) {
  KINESCOPE_CHECK(a.type == b.type && a.sample_counter == b.sample_counter && a.part == b.part &&
                  a.is_last_part == b.is_last_part && a.time_code_millis == b.time_code_millis &&
                  a.character == b.character && a.body_segments == b.body_segments &&
                  a.props == b.props && a.finger_segments == b.finger_segments);
}

// Whether the encoder can write it so that it means the same. Items that were skipped are not
// written, so a message of nothing else would be refused.
struct IsWritable {
  const Header& header;

  template <class Item>
  bool HasItems(const PerSegment<Item>& body) const {
    // A header that is too old to tell props and fingers cannot say what their ids count from.
    if (header.body_segments == 0 && (body.present >> kinescope::urdf::kSegmentCount).any()) {
      return false;
    }
    // Told by their place or by their id, but not by both: skipped or odd ones would shift it.
    return body.present.any() && body.skipped == 0 && body.mismatched_ids == 0;
  }
  bool operator()(const PoseMessage& body) const { return HasItems(body); }
  bool operator()(const EulerPoseMessage& body) const { return HasItems(body); }
  bool operator()(const LinearMessage& body) const { return HasItems(body); }
  bool operator()(const AngularMessage& body) const { return HasItems(body); }
  bool operator()(const JointAnglesMessage& body) const {
    // Vertical_T8 alone would come back as its twin.
    return (body.joints_present.any() || body.ergonomic_present.any()) &&
           (!body.ergonomic_present.test(kVerticalT8) || body.ergonomic_present.test(kPelvisT8));
  }
  bool operator()(const TrackersMessage& body) const { return body.present.any(); }
  template <class Content>
  bool operator()(const Content&) const {
    return true;
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLargestDatagram) return 0;  // no network can deliver it
  const auto message = ParseDatagram({reinterpret_cast<const char*>(data), size});
  if (!message) {
    KINESCOPE_CHECK(message.error().offset <= size);
    KINESCOPE_CHECK(!Describe(message.error()).empty());
    return 0;
  }
  if (!std::visit(IsWritable{message->header}, message->body)) return 0;
  const auto again = ParseDatagram(Encode(*message));
  KINESCOPE_CHECK(again.has_value());
  CheckSameHeader(message->header, again->header);
  KINESCOPE_CHECK(message->body.index() == again->body.index());
  std::visit(SameBody{again->body}, message->body);
  return 0;
}

}  // namespace datagram_fuzz
