#include "server/mvn/encode.h"

#include <cstdio>
#include <utility>

#include "server/core/check.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kLargestPayload = 65535 - kHeaderBytes;

void WriteVector(ByteWriter& out, const Eigen::Vector3d& value) {
  for (const double number : value) out.WriteFloat(number);
}

void WriteQuaternion(ByteWriter& out, const Eigen::Quaterniond& value) {
  for (const double number : {value.w(), value.x(), value.y(), value.z()}) out.WriteFloat(number);
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

template <class Item>
constexpr Type kTypeOf = Type::kPose;
template <>
constexpr Type kTypeOf<LinearItem> = Type::kLinear;
template <>
constexpr Type kTypeOf<AngularItem> = Type::kAngular;

// Writes one body; says its type and its number of items.
struct BodyWriter {
  using TypeAndCount = std::pair<Type, std::size_t>;
  ByteWriter& out;

  template <class Item>
  TypeAndCount operator()(const PerSegment<Item>& body) const {
    for (std::size_t segment = 0; segment < body.items.size(); ++segment) {
      if (!body.present.test(segment)) continue;
      out.Write(static_cast<std::uint32_t>(segment + 1));
      WriteItem(out, body.items[segment]);
    }
    return {kTypeOf<Item>, body.present.count()};
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

  TypeAndCount operator()(const CenterOfMassMessage& body) const {
    WriteVector(out, body.position);
    if (body.has_derivatives) {
      WriteVector(out, body.velocity);
      WriteVector(out, body.acceleration);
    }
    return {Type::kCenterOfMass, 1};
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
    return {Type::kScale, 0};  // MVN leaves the item count of type 13 at zero
  }

  TypeAndCount operator()(const NotNeeded&) const {
    KINESCOPE_CHECK(!"a body that was never read cannot be written");
    return {};
  }
};

void WriteHeader(ByteWriter& out, const Header& header) {
  out.Write(static_cast<std::uint8_t>('0' + static_cast<int>(header.type) / 10));
  out.Write(static_cast<std::uint8_t>('0' + static_cast<int>(header.type) % 10));
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

Message MessageFor(int character, Body body) {
  Message message;
  message.header.character = character;
  message.header.body_segments = urdf::kSegmentCount;
  message.body = std::move(body);
  return message;
}

// The points that Kinescope's own reader looks for, numbered as MVN numbers them.
std::vector<ScalePoint> EndPoints(const urdf::Skeleton& skeleton) {
  std::vector<ScalePoint> points;
  const auto add = [&points](int segment, int point_id, std::string name,
                             const Eigen::Vector3d& in_link) {
    points.push_back(
        {segment + 1, point_id, std::move(name), 0, urdf::SegmentFromLink(segment) * in_link});
  };
  add(urdf::kHead, 2, "pTopOfHead", skeleton.head_top_in_head);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const bool right = side == urdf::kRight;
    const std::string prefix = right ? "pRight" : "pLeft";
    add(right ? urdf::kRightHand : urdf::kLeftHand, 2, prefix + "TopOfHand",
        skeleton.finger_tip_in_hand[side]);
    add(right ? urdf::kRightFoot : urdf::kLeftFoot, 3, prefix + "HeelFoot",
        skeleton.heel_in_foot[side]);
    add(right ? urdf::kRightToe : urdf::kLeftToe, 2, prefix + "Toe", skeleton.toe_tip_in_toe[side]);
  }
  return points;
}

template <class Item, class Fill>
PerSegment<Item> ForAllSegments(const BodySample& sample, const Fill& fill) {
  PerSegment<Item> body;
  body.present.set();
  for (std::size_t i = 0; i < body.items.size(); ++i) fill(sample.segments[i], body.items[i]);
  return body;
}

}  // namespace

std::string Encode(const Message& message) {
  std::string payload;
  ByteWriter payload_out(payload);
  Header header = message.header;
  const auto [type, items] = std::visit(BodyWriter{payload_out}, message.body);
  KINESCOPE_CHECK(payload.size() <= kLargestPayload);
  header.type = type;
  header.item_count = static_cast<int>(items);
  header.payload_bytes = static_cast<int>(payload.size());
  std::string datagram = "MXTP";
  ByteWriter out(datagram);
  WriteHeader(out, header);
  return datagram += payload;
}

std::array<Eigen::Vector3d, urdf::kSegmentCount> TPoseOrigins(const urdf::Skeleton& skeleton) {
  std::array<Eigen::Vector3d, urdf::kSegmentCount> origins;
  origins[urdf::kPelvis] =
      urdf::NPoseOrigins(skeleton)[urdf::kPelvis];  // legs are as in the N-pose
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const auto index = static_cast<std::size_t>(segment);
    const int parent = urdf::kSegments[index].parent;
    origins[index] = origins[static_cast<std::size_t>(parent)] +
                     urdf::SegmentFromLink(parent) * skeleton.origin_in_parent[index];
  }
  return origins;
}

std::vector<std::string> EncodeSample(const BodySample& sample) {
  std::vector<std::string> datagrams;
  const auto add = [&](Body body) {
    Message message = MessageFor(sample.character, std::move(body));
    message.header.sample_counter = sample.counter;
    message.header.time_code_millis = static_cast<std::uint32_t>(sample.time_code_millis);
    datagrams.push_back(Encode(message));
  };
  add(ForAllSegments<PoseItem>(sample, [](const SegmentState& from, PoseItem& to) {
    to = {from.position, from.orientation};
  }));
  if (sample.streamed_angles_deg) {
    JointAnglesMessage body;
    body.joints = *sample.streamed_angles_deg;
    body.joints_present.set();
    add(body);
  }
  if (sample.has_linear) {
    add(ForAllSegments<LinearItem>(sample, [](const SegmentState& from, LinearItem& to) {
      to = {from.position, from.velocity, from.acceleration};
    }));
  }
  if (sample.has_angular) {
    add(ForAllSegments<AngularItem>(sample, [](const SegmentState& from, AngularItem& to) {
      to = {from.orientation, from.angular_velocity, from.angular_acceleration};
    }));
  }
  if (sample.com) {
    add(CenterOfMassMessage{sample.com->position, sample.com->velocity, sample.com->acceleration,
                            sample.com->has_derivatives});
  }
  return datagrams;
}

std::vector<std::string> EncodeCharacter(const Character& character) {
  MetaDataMessage meta;
  if (!character.name.empty()) meta.name = CleanText(character.name, kLongestName);
  meta.color_rgb = character.color_rgb;
  std::vector<std::string> datagrams = {Encode(MessageFor(character.id, meta))};
  if (!character.skeleton) return datagrams;
  ScaleMessage segments;
  const auto origins = TPoseOrigins(*character.skeleton);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    segments.segments.push_back({std::string(urdf::kSegments[i].mvn_name), origins[i]});
  }
  ScaleMessage points;
  points.points = EndPoints(*character.skeleton);
  Message first = MessageFor(character.id, segments);
  first.header.is_last_part = false;
  Message second = MessageFor(character.id, points);
  second.header.part = 1;
  datagrams.push_back(Encode(first));
  datagrams.push_back(Encode(second));
  return datagrams;
}

}  // namespace kinescope::mvn
