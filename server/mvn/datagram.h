/// One datagram of the MVN stream ("MXTP", MV0305P rev N and what later senders do), parsed into
/// values that can be used as they are: every number finite, every quaternion of unit length, every
/// index inside its array. World frame and segment frames as in body_sample.h; metres, radians,
/// except joint angles, which the stream has in degrees.
///
/// Pure functions, no state, any thread. Parsing allocates nothing but for
/// the names in 12 and 13.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "core/body_sample.h"
#include "urdf/segments.h"

namespace kinescope::mvn {

inline constexpr std::size_t kHeaderBytes = 24;
inline constexpr std::size_t kLargestDatagram = 65536;  // more than UDP can carry

/// The two digits after "MXTP", read as a decimal number. Types that Kinescope knows.
enum class Type : std::uint8_t {
  kEulerPose = 1,
  kPose = 2,
  kMarkers = 3,
  kMetaData = 12,
  kScale = 13,
  kJointAngles = 20,
  kLinear = 21,
  kAngular = 22,
  kTrackers = 23,
  kCenterOfMass = 24,
  kTimeCode = 25,
};

struct Header {
  Type type = Type::kPose;
  std::uint32_t sample_counter = 0;  // captured frames, not sent ones; 0 in 12 and 13
  int part = 0;                      // of a message that is split; 0..127
  bool is_last_part = true;
  int item_count = 0;  // as sent: 0 in type 13, and it means nothing in 12, 24, 25
  std::uint32_t time_code_millis = 0;
  int character = 0;      // 0..255
  int body_segments = 0;  // 0 from senders before 2018
  int props = 0;
  int finger_segments = 0;
  int payload_bytes = 0;  // 0 from senders before 2018
};

struct PoseItem {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // in the world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_segment, unit
};

struct LinearItem {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
};

struct AngularItem {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
};

/// Items by slot: the body by urdf::Segment, then what ExtraSegments holds, in its order. A slot
/// does not depend on how many props are sent; the id in the stream does.
inline constexpr int kSlotCount = urdf::kSegmentCount + kExtraCount;

/// What one datagram says about segments; items that are not `present` hold their defaults.
template <class Item>
struct PerSegment {
  std::array<Item, kSlotCount> items{};
  std::bitset<kSlotCount> present;
  int skipped = 0;  // ids that are no segment, prop or finger by the header's numbers of them
  int odd_ids = 0;  // props and fingers told by their place, whose id says something else

  bool HasBody() const {  // all 23
    constexpr unsigned long long kBody = (1ULL << urdf::kSegmentCount) - 1;
    return (present & std::bitset<kSlotCount>(kBody)) == std::bitset<kSlotCount>(kBody);
  }
};

struct PoseMessage : PerSegment<PoseItem> {};        // 02
struct LinearMessage : PerSegment<LinearItem> {};    // 21
struct AngularMessage : PerSegment<AngularItem> {};  // 22

/// 01. In the stream Y-up, centimetres and degrees; here as 02 has it.
struct EulerPoseMessage : PerSegment<PoseItem> {};

struct MarkerItem {
  std::uint32_t segment_id = 1;                        // from 1
  std::uint32_t point_id = 0;                          // within the segment
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, Z-up, m
};

struct MarkersMessage {  // 03. In the stream Y-up and centimetres
  std::array<MarkerItem, 255> markers{};
  int count = 0;
};

struct TrackersMessage {  // 23, by the segment that carries the sensor
  std::array<TrackerState, urdf::kSegmentCount> trackers{};
  std::bitset<urdf::kSegmentCount> present;
  int skipped = 0;
};

struct TimeCodeMessage {               // 25
  std::int32_t utc_millis_of_day = 0;  // 0 to 86 399 999; a leap second counts as the one before
};

/// The six joints after the 22 of the body, in the order of the stream.
enum ErgonomicJoint : int {
  kT8Head,
  kT8LeftUpperArm,
  kT8RightUpperArm,
  kPelvisT8,
  kVerticalPelvis,
  kVerticalT8,  // since MVN 2019.1
};
inline constexpr int kErgonomicJointCount = 6;

struct JointAnglesMessage {  // 20; degrees, MVN's own (x, y, z)
  std::array<Eigen::Vector3d, urdf::kJointCount> joints{};
  std::bitset<urdf::kJointCount> joints_present;
  std::array<Eigen::Vector3d, kErgonomicJointCount> ergonomic{};
  std::bitset<kErgonomicJointCount> ergonomic_present;
  int skipped = 0;  // pairs of points that are no joint we know

  JointAnglesMessage() {
    joints.fill(Eigen::Vector3d::Zero());
    ergonomic.fill(Eigen::Vector3d::Zero());
  }
};

struct CenterOfMassMessage {  // 24
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  bool has_derivatives = false;  // false: the 12-byte form of old senders
};

struct MetaDataMessage {                   // 12: each may hold any of the tags
  std::optional<std::string> name;         // valid UTF-8 without control characters
  std::optional<std::uint32_t> color_rgb;  // 0xRRGGBB
};

struct ScaleSegment {
  std::string name;
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();  // in the T-pose
};

struct ScalePoint {
  int segment_id = 1;  // from 1, may be a prop's or a finger's
  int point_id = 0;    // within the segment
  std::string name;
  std::uint32_t flags = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the segment's origin, segment frame
};

struct ScaleMessage {  // 13, one part: segments start over, points add to what was sent
  std::vector<ScaleSegment> segments;
  std::vector<ScalePoint> points;
};

using Body = std::variant<PoseMessage, EulerPoseMessage, MarkersMessage, JointAnglesMessage,
                          LinearMessage, AngularMessage, TrackersMessage, CenterOfMassMessage,
                          TimeCodeMessage, MetaDataMessage, ScaleMessage>;

struct Message {
  Header header;
  Body body;
};

/// Whether messages of `type` are part of a sample. 12 and 13 are not: they carry counter and time
/// code 0 in the middle of a stream.
inline bool BelongsToSample(Type type) { return type != Type::kMetaData && type != Type::kScale; }

/// The two digits of a message type in the stream: "02".
std::string TypeDigits(Type type);

/// Why a datagram or a sample is not used. A small fixed set, so that each can be a counter.
enum class Reason : std::uint8_t {
  kEmpty,
  kJsonText,
  kXmlText,
  kForeignText,
  kForeign,
  kShortHeader,
  kUnknownType,
  kType04,
  kType05,
  kType10,
  kType11,
  kShortPayload,
  kItemCount,
  kPayloadSize,
  kLyingCount,
  kLyingLength,
  kNotFinite,
  kOutOfRange,
  kNotUnit,
  kIdZero,
  kRepeatedId,
  kTimeOfDay,
  // Found when datagrams are joined:
  kPartsContradict,
  kNoWholePose,
  kTooManyStreams,
  kSecondSender,
  kScaleWithoutBody,
  kScaleNotHuman,
};
inline constexpr int kReasonCount = static_cast<int>(Reason::kScaleNotHuman) + 1;

/// For people and as the key of a counter, such as "id 0"; never holds a value of the datagram.
const char* Text(Reason reason);

struct ParseError {
  std::size_t offset = 0;  // byte at which parsing stopped
  Reason reason = Reason::kEmpty;
  std::int64_t value = 0;  // what was wrong there: the id, the count, the length
};

/// One line, such as "byte 24: id 0 (value 0)".
std::string Describe(const ParseError& error);

/// The header alone, without a look at the body: what can be told of a datagram whatever is in it.
[[nodiscard]] tl::expected<Header, ParseError> ParseHeader(std::string_view datagram);

[[nodiscard]] tl::expected<Message, ParseError> ParseDatagram(std::string_view datagram);

/// Parent and child point of a joint, as type 20 names them: 256 * segment id + point.
struct PointPair {
  std::uint32_t parent = 0;
  std::uint32_t child = 0;
};
PointPair PointsOf(urdf::Joint joint);
PointPair PointsOf(ErgonomicJoint joint);

}  // namespace kinescope::mvn
