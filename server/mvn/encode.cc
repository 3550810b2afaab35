#include "server/mvn/encode.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/system/check.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kLargestPayload = 65535 - kHeaderBytes;
constexpr std::size_t kMaxItems = 255;
constexpr double kDegrees = 180 / M_PI;

void WriteVector(ByteWriter& out, const Eigen::Vector3d& value) {
  for (const double number : value) out.WriteFloat(number);
}

void WriteQuaternion(ByteWriter& out, const Eigen::Quaterniond& value) {
  for (const double number : {value.w(), value.x(), value.y(), value.z()}) out.WriteFloat(number);
}

void WriteCentimetresYUp(ByteWriter& out, const Eigen::Vector3d& metres_zup) {
  WriteVector(out, ToYUp(metres_zup) / kMetresPerCentimetre);
}

// Angles about fixed x, then y, then z, of a rotation about the Y-up axes.
Eigen::Vector3d YUpAngles(const Eigen::Quaterniond& zup) {
  const Eigen::Vector3d axis = ToYUp(zup.vec());
  const Eigen::Matrix3d r =
      Eigen::Quaterniond(zup.w(), axis.x(), axis.y(), axis.z()).toRotationMatrix();
  const double cos_y = std::hypot(r(0, 0), r(1, 0));
  const double y = std::atan2(-r(2, 0), cos_y);
  constexpr double kLocked = 1e-9;  // x and z rotate about the same axis: all of it is in x
  if (cos_y < kLocked) return {std::atan2(-r(1, 2), r(1, 1)), y, 0};
  return {std::atan2(r(2, 1), r(2, 2)), y, std::atan2(r(1, 0), r(0, 0))};
}

void WriteItem(ByteWriter& out, const PoseItem& item) {
  WriteVector(out, item.position);
  WriteQuaternion(out, item.orientation);
}

void WriteItem(ByteWriter& out, const LinearItem& item) {
  WriteVector(out, item.position);
  WriteVector(out, item.velocity);
  WriteVector(out, item.acceleration);
}

void WriteItem(ByteWriter& out, const AngularItem& item) {
  WriteQuaternion(out, item.orientation);
  WriteVector(out, item.velocity);
  WriteVector(out, item.acceleration);
}

void WriteEulerItem(ByteWriter& out, const PoseItem& item) {
  WriteCentimetresYUp(out, item.position);
  WriteVector(out, YUpAngles(item.orientation) * kDegrees);
}

// The id of a slot, which depends on the number of props: the ids of fingers follow theirs.
std::uint32_t IdOf(std::size_t slot, const Header& header) {
  constexpr std::size_t kFirstFinger = urdf::kSegmentCount + kMaxProps;
  const auto props = static_cast<std::size_t>(header.props);
  if (slot < kFirstFinger) {
    KINESCOPE_CHECK(slot < urdf::kSegmentCount + props);
    return static_cast<std::uint32_t>(slot + 1);
  }
  return static_cast<std::uint32_t>(urdf::kSegmentCount + props + (slot - kFirstFinger) + 1);
}

// Writes one body; returns its type and its number of items.
struct BodyWriter {
  using TypeAndCount = std::pair<Type, std::size_t>;
  ByteWriter& out;
  const Header& header;

  TypeAndCount operator()(const PoseMessage& body) const {
    return WriteSegments(Type::kPose, body, [this](const PoseItem& item) { WriteItem(out, item); });
  }
  TypeAndCount operator()(const EulerPoseMessage& body) const {
    return WriteSegments(Type::kEulerPose, body,
                         [this](const PoseItem& item) { WriteEulerItem(out, item); });
  }
  TypeAndCount operator()(const LinearMessage& body) const {
    return WriteSegments(Type::kLinear, body,
                         [this](const LinearItem& item) { WriteItem(out, item); });
  }
  TypeAndCount operator()(const AngularMessage& body) const {
    return WriteSegments(Type::kAngular, body,
                         [this](const AngularItem& item) { WriteItem(out, item); });
  }

  TypeAndCount operator()(const MarkersMessage& body) const {
    for (int i = 0; i < body.count; ++i) {
      const MarkerItem& marker = body.markers[static_cast<std::size_t>(i)];
      out.Write(256 * marker.segment_id + marker.point_id);
      WriteCentimetresYUp(out, marker.position);
    }
    return {Type::kMarkers, static_cast<std::size_t>(body.count)};
  }

  TypeAndCount operator()(const JointAnglesMessage& body) const {
    const auto write = [this](const PointPair& points, const Eigen::Vector3d& angles) {
      out.Write(points.parent);
      out.Write(points.child);
      WriteVector(out, angles);
    };
    for (std::size_t i = 0; i < body.joints.size(); ++i) {
      if (body.joints_present.test(i)) write(PointsOf(static_cast<urdf::Joint>(i)), body.joints[i]);
    }
    for (std::size_t i = 0; i < body.ergonomic.size(); ++i) {
      if (!body.ergonomic_present.test(i)) continue;
      write(PointsOf(static_cast<ErgonomicJoint>(i)), body.ergonomic[i]);
    }
    return {Type::kJointAngles, body.joints_present.count() + body.ergonomic_present.count()};
  }

  TypeAndCount operator()(const TrackersMessage& body) const {
    bool have_rates = false;
    for (std::size_t i = 0; i < body.trackers.size(); ++i) {
      have_rates |= body.present.test(i) && body.trackers[i].has_rates;
    }
    for (std::size_t i = 0; i < body.trackers.size(); ++i) {
      if (!body.present.test(i)) continue;
      const TrackerState& tracker = body.trackers[i];
      out.Write(static_cast<std::uint32_t>(i + 1));
      WriteQuaternion(out, tracker.orientation);
      WriteVector(out, tracker.free_acceleration);
      if (have_rates) {
        WriteVector(out, tracker.acceleration);
        WriteVector(out, tracker.angular_velocity);
      }
      WriteVector(out, tracker.magnetic_field);
    }
    return {Type::kTrackers, body.present.count()};
  }

  TypeAndCount operator()(const CenterOfMassMessage& body) const {
    WriteVector(out, body.position);
    if (body.has_derivatives) {
      WriteVector(out, body.velocity);
      WriteVector(out, body.acceleration);
    }
    return {Type::kCenterOfMass, 1};
  }

  TypeAndCount operator()(const TimeCodeMessage& body) const {
    const std::int32_t millis = body.utc_millis_of_day;
    const std::int32_t seconds = millis / 1000;
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%02d:%02d:%02d.%03d", seconds / 3600,
                  seconds / 60 % 60, seconds % 60, millis % 1000);
    out.WriteText(text.data());
    return {Type::kTimeCode, 1};
  }

  TypeAndCount operator()(const MetaDataMessage& body) const {
    std::string text;
    if (body.color_rgb) {
      std::array<char, 16> color{};
      std::snprintf(color.data(), color.size(), "color:%06x\n", *body.color_rgb & 0xFFFFFFU);
      text += color.data();
    }
    text += "count:1\n";
    if (body.name) text += "name:" + *body.name + "\n";
    text += "timeOffset:0\n";
    out.WriteText(text);
    return {Type::kMetaData, 1};
  }

  TypeAndCount operator()(const ScaleMessage& body) const {
    out.Write(static_cast<std::uint32_t>(body.segments.size()));
    for (const ScaleSegment& segment : body.segments) {
      out.WriteText(segment.name);
      WriteVector(out, segment.origin_in_world);
    }
    out.Write(static_cast<std::uint32_t>(body.points.size()));
    for (const ScalePoint& point : body.points) {
      out.Write(static_cast<std::uint16_t>(point.segment_id));
      out.Write(static_cast<std::uint16_t>(point.point_id));
      out.WriteText(point.name);
      out.Write(point.flags);
      WriteVector(out, point.offset);
    }
    return {Type::kScale, 0};  // MVN sends an item count of 0 in type 13
  }

 private:
  template <class Item, class Write>
  TypeAndCount WriteSegments(Type type, const PerSegment<Item>& body, const Write& write) const {
    for (std::size_t slot = 0; slot < body.items.size(); ++slot) {
      if (!body.present.test(slot)) continue;
      out.Write(IdOf(slot, header));
      write(body.items[slot]);
    }
    return {type, body.present.count()};
  }
};

// The header after the id string.
void WriteHeader(ByteWriter& out, const Header& header) {
  out.Write(header.sample_counter);
  out.Write(static_cast<std::uint8_t>(header.part | (header.is_last_part ? 0x80 : 0)));
  out.Write(static_cast<std::uint8_t>(header.item_count));
  out.Write(header.time_code_millis);
  for (const int byte :
       {header.character, header.body_segments, header.props, header.finger_segments}) {
    out.Write(static_cast<std::uint8_t>(byte));
  }
  out.Write(std::uint16_t{0});  // reserved
  out.Write(static_cast<std::uint16_t>(header.payload_bytes));
}

}  // namespace

std::string Encode(const Message& message) {
  std::string payload;
  ByteWriter payload_out(payload);
  Header header = message.header;
  const auto [type, items] = std::visit(BodyWriter{payload_out, message.header}, message.body);
  KINESCOPE_CHECK(payload.size() <= kLargestPayload && items <= kMaxItems);
  header.type = type;
  header.item_count = static_cast<int>(items);
  header.payload_bytes = static_cast<int>(payload.size());
  std::string datagram = "MXTP" + TypeDigits(type);
  ByteWriter out(datagram);
  WriteHeader(out, header);
  return datagram += payload;
}

void PatchHeader(const HeaderPatch& patch, std::string& datagram) {
  KINESCOPE_CHECK(datagram.size() >= kHeaderBytes);
  constexpr std::size_t kCounterAt = 6, kTimeCodeAt = 12, kCharacterAt = 16;
  const auto write = [&datagram](std::size_t at, auto value) {
    std::string bytes;
    ByteWriter(bytes).Write(value);
    datagram.replace(at, bytes.size(), bytes);
  };
  if (patch.sample_counter) write(kCounterAt, *patch.sample_counter);
  if (patch.time_code_millis) write(kTimeCodeAt, *patch.time_code_millis);
  if (patch.character) write(kCharacterAt, static_cast<std::uint8_t>(*patch.character));
}

}  // namespace kinescope::mvn
