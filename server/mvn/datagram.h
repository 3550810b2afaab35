/// Parses one datagram of the MVN stream ("MXTP", MV0305P rev N and what later senders add) into
/// values that need no further check: every number is finite, every quaternion has unit length,
/// every index is inside its array. World frame and segment frames as in body_sample.h; metres,
/// radians, but joint angles in degrees, as in the stream.
///
/// Pure functions, no state, any thread. Only the names in 12 and 13 are allocated.
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
inline constexpr std::size_t kLargestDatagram = 65536;  // bytes; more than UDP can carry

/// The message types that Kinescope knows. Value: the two digits after "MXTP", as a decimal number.
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
  std::uint32_t sample_counter = 0;  // counts captured samples, not sent ones; 0 in 12 and 13
  int part = 0;                      // of a message that is split; 0..127
  bool is_last_part = true;
  int item_count = 0;  // as sent: 0 in type 13, without meaning in 12, 24, 25
  std::uint32_t time_code_millis = 0;
  int character = 0;      // 0..255
  int body_segments = 0;  // 0 from senders before 2018
  int props = 0;
  int finger_segments = 0;
  int payload_bytes = 0;  // 0 from senders before 2018
};

struct PoseItem {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // world, m
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

/// Items by slot: the body by urdf::Segment, then the segments of FingerAndPropSegments in its
/// order. The slot does not depend on the number of props; the id in the stream does.
inline constexpr int kSlotCount = urdf::kSegmentCount + kFingerAndPropCount;

/// The items of one datagram, one per segment; items that are not `present` have default values.
template <class Item>
struct PerSegment {
  std::array<Item, kSlotCount> items{};
  std::bitset<kSlotCount> present;
  int skipped = 0;  // ids that are no segment, prop or finger according to the numbers in the
                    // header
  int mismatched_ids =
      0;  // props and fingers identified by their place because their id contradicts it

  bool HasBody() const {  // all 23
    constexpr unsigned long long kBody = (1ULL << urdf::kSegmentCount) - 1;
    return (present & std::bitset<kSlotCount>(kBody)) == std::bitset<kSlotCount>(kBody);
  }
};

struct PoseMessage : PerSegment<PoseItem> {};        // 02
struct LinearMessage : PerSegment<LinearItem> {};    // 21
struct AngularMessage : PerSegment<AngularItem> {};  // 22

/// 01. In the stream Y-up, centimetres and degrees; here converted to the form of 02.
struct EulerPoseMessage : PerSegment<PoseItem> {};

struct MarkerItem {
  std::uint32_t segment_id = 1;                        // from 1
  std::uint32_t point_id = 0;                          // within the segment
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, Z-up, m
};

struct MarkersMessage {  // 03. In the stream Y-up and centimetres; here converted
  std::array<MarkerItem, 255> markers{};
  int count = 0;
};

struct TrackersMessage {  // 23, indexed by the segment that carries the sensor
  std::array<TrackerState, urdf::kSegmentCount> trackers{};
  std::bitset<urdf::kSegmentCount> present;
  int skipped = 0;
};

struct TimeCodeMessage {               // 25
  std::int32_t utc_millis_of_day = 0;  // 0 to 86 399 999; a leap second repeats the second before
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
  int skipped = 0;  // pairs of points that are no known joint

  JointAnglesMessage() {
    joints.fill(Eigen::Vector3d::Zero());
    ergonomic.fill(Eigen::Vector3d::Zero());
  }
};

struct CenterOfMassMessage {  // 24; world, m, m/s, m/s^2
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  bool has_derivatives = false;  // false: the 12-byte form of old senders
};

struct MetaDataMessage {                   // 12; every tag is optional
  std::optional<std::string> name;         // valid UTF-8 without control characters
  std::optional<std::uint32_t> color_rgb;  // 0xRRGGBB
};

struct ScaleSegment {
  std::string name;
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();  // in the T-pose, m
};

struct ScalePoint {
  int segment_id = 1;  // from 1; may be a prop or a finger
  int point_id = 0;    // within the segment
  std::string name;
  std::uint32_t flags = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the segment's origin, segment frame, m
};

struct ScaleMessage {  // 13, one part: segments replace earlier ones, points add to them
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

/// Whether messages of `type` are part of a sample. 12 and 13 are not: their counter and time code
/// are 0 in the middle of a stream.
inline bool BelongsToSample(Type type) { return type != Type::kMetaData && type != Type::kScale; }

/// The two digits of a message type in the stream: "02".
std::string TypeDigits(Type type);

/// Why a datagram or a sample is rejected. A fixed set, so that each reason has a counter.
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
  // Detected when samples are assembled:
  kPartsContradict,
  kNoWholePose,
  kTooManyStreams,
  kSecondSender,
  kScaleWithoutBody,
  kScaleNotHuman,
};
inline constexpr int kReasonCount = static_cast<int>(Reason::kScaleNotHuman) + 1;

/// Text for messages and key of a counter, such as "id 0"; never contains a value of the datagram.
const char* Text(Reason reason);

struct ParseError {
  std::size_t offset = 0;  // byte at which parsing stopped
  Reason reason = Reason::kEmpty;
  std::int64_t value = 0;  // the invalid value: the id, the count, the length
};

/// One line, such as "byte 24: id 0 (value 0)".
std::string Describe(const ParseError& error);

/// Parses the header only: the part that can be read whatever the body contains.
[[nodiscard]] tl::expected<Header, ParseError> ParseHeader(std::string_view datagram);

[[nodiscard]] tl::expected<Message, ParseError> ParseDatagram(std::string_view datagram);

/// Whether `message` alone has all 23 segments (types 01, 02, 21, 22).
bool HasWholeBody(const Message& message);

/// Parent and child point of a joint, as in type 20: 256 * segment id + point.
struct PointPair {
  std::uint32_t parent = 0;
  std::uint32_t child = 0;
};
PointPair PointsOf(urdf::Joint joint);
PointPair PointsOf(ErgonomicJoint joint);

}  // namespace kinescope::mvn
