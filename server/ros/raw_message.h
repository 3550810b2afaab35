/// Holds a message of a ROS topic as bytes. Array sizes in the message are untrusted, and roscpp
/// allocates memory before it checks them. The functions here check them first. One thread.
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

/// Subscribes to a topic of any type; the connection states the actual type.
struct RawMessage {
  std::vector<std::uint8_t> bytes;
};

/// Decodes `bytes`; false if the message is truncated or an array size is wrong. `message` keeps
/// its memory from call to call.
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes, tf2_msgs::TFMessage& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          xsens_mvn_ros_msgs::LinkStateArray& message);

[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::Marker& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::MarkerArray& message);

inline constexpr std::size_t kLargestMessage = 16 << 20;  // bytes: 100,000 transforms

/// Why a pose is rejected, as the key of its counter: a number that is not finite, a position more
/// than 1000 km away, a quaternion whose norm is off by more than 1e-3. Null if it is valid.
[[nodiscard]] const char* DefectOf(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw);

/// The name as in tf2, without the leading slash of tf.
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
