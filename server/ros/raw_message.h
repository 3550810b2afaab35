/// A message of a ROS topic as its bytes. Whoever sends it chose the counts in it: roscpp would
/// reserve memory for what they claim before it looks whether they can be true. Here they are
/// looked at first. One thread.
#pragma once

#include <geometry_msgs/Transform.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <cstdint>
#include <string>
#include <vector>

#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

/// Subscribes to a topic of any type; which one it is, the connection says.
struct RawMessage {
  std::vector<std::uint8_t> bytes;
};

/// What `bytes` hold; false when the message is cut short or lies about its length. `message` keeps
/// its memory from call to call.
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes, tf2_msgs::TFMessage& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          xsens_mvn_ros_msgs::LinkStateArray& message);

[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::Marker& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::MarkerArray& message);

inline constexpr std::size_t kLargestMessage = 16 << 20;  // bytes: 100,000 transforms

/// Why a pose cannot be used, as the counter under which it goes: a number that is not finite, a
/// position more than 1000 km away, a quaternion whose norm is off by more than 1e-3. Null when it
/// can.
[[nodiscard]] const char* DefectOf(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw);

/// tf2 has no slash before a frame's name, tf had one.
[[nodiscard]] std::string WithoutSlash(const std::string& frame);

}  // namespace kinescope::ros_bridge

namespace ros {
namespace message_traits {
template <>
struct IsMessage<kinescope::ros_bridge::RawMessage> : TrueType {};
template <>
struct MD5Sum<kinescope::ros_bridge::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const kinescope::ros_bridge::RawMessage&) { return "*"; }
};
template <>
struct DataType<kinescope::ros_bridge::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const kinescope::ros_bridge::RawMessage&) { return "*"; }
};
template <>
struct Definition<kinescope::ros_bridge::RawMessage> {
  static const char* value() { return ""; }
  static const char* value(const kinescope::ros_bridge::RawMessage&) { return ""; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<kinescope::ros_bridge::RawMessage> {
  template <class Stream>
  static void read(Stream& stream, kinescope::ros_bridge::RawMessage& message) {
    message.bytes.assign(stream.getData(), stream.getData() + stream.getLength());
  }
};
}  // namespace serialization
}  // namespace ros
