/// Decodes messages of ROS topics. Array sizes in a message are untrusted, and roscpp allocates
/// memory before it checks them: a message of four bytes can take gigabytes. The types and
/// functions here check them first. One thread.
#pragma once

#include <geometry_msgs/Transform.h>
#include <ros/message_event.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

/// Subscribes to a topic of any type; the connection states the actual type.
struct RawMessage {
  std::vector<std::uint8_t> bytes;
};

using RawEvent = ros::MessageEvent<const RawMessage>;

/// Bytes of the type of a topic in messages and in names of counters: a publisher is untrusted.
inline constexpr std::size_t kLongestTypeName = 80;

/// What its publisher says of the connection, such as the "type" or the "md5sum"; "": nothing.
[[nodiscard]] std::string Said(const RawEvent& event, const char* key);

/// Decodes `bytes`; false if the message is truncated or an array size is wrong. `message` keeps
/// its memory from call to call.
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes, tf2_msgs::TFMessage& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          xsens_mvn_ros_msgs::LinkStateArray& message);

[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::Marker& message);
[[nodiscard]] bool Decode(const std::vector<std::uint8_t>& bytes,
                          visualization_msgs::MarkerArray& message);

/// Whether a connection with this sum has messages of that type.
template <class Message>
bool Is(const std::string& md5sum) {
  return md5sum == ros::message_traits::md5sum<Message>();
}

inline constexpr std::size_t kLargestMessage = 64 << 20;  // bytes: two million points of a cloud

/// Subscribes to a topic of `Message` without trusting its array sizes. To publishers and in the
/// registration it is a `Message`.
template <class Message>
struct BoundedMessage {
  Message message;
  bool is_sound = false;  // false: it is truncated, too large, or has a wrong array size
};

/// Reads as roscpp's IStream, but lists grow while their elements are read: their memory is limited
/// by the bytes that are there, not by the size that the message states.
class BoundedStream : public ros::serialization::Stream {
 public:
  static constexpr ros::serialization::StreamType stream_type =
      ros::serialization::stream_types::Input;

  /// Reads only, but the base class requires writable bytes.
  BoundedStream(const std::uint8_t* bytes, std::uint32_t size)
      : Stream(const_cast<std::uint8_t*>(bytes), size) {}

  /// The base class first computes an address behind the bytes, which may not exist.
  std::uint8_t* advance(std::uint32_t size) {
    if (size > getLength()) ros::serialization::throwStreamOverrun();
    return Stream::advance(size);
  }

  template <class T>
  void next(T& value) {
    ros::serialization::Serializer<T>::read(*this, value);
  }

  template <class Allocator>
  void next(std::vector<std::uint8_t, Allocator>& bytes) {
    std::uint32_t count = 0;
    next(count);
    const std::uint8_t* const first = advance(count);
    bytes.assign(first, first + count);
  }

  template <class T, std::size_t size>
  void next(boost::array<T, size>& values) {
    for (T& value : values) next(value);
  }

  template <class T, class Allocator>
  void next(std::vector<T, Allocator>& list) {
    std::uint32_t count = 0;
    next(count);
    if (count > getLength()) ros::serialization::throwStreamOverrun();
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i == list.size()) list.emplace_back();
      next(list[i]);
    }
    list.resize(count);
  }
};

/// False if the bytes are not all of a `Message`, whose contents are then unspecified.
template <class Message>
[[nodiscard]] bool ReadBounded(const std::uint8_t* bytes, std::size_t size, Message& message) {
  if (size > kLargestMessage) return false;
  try {
    BoundedStream in(bytes, static_cast<std::uint32_t>(size));
    in.next(message);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

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
template <class Message>
struct IsMessage<kinescope::ros_bridge::BoundedMessage<Message>> : TrueType {};
template <class Message>
struct MD5Sum<kinescope::ros_bridge::BoundedMessage<Message>> {
  static const char* value() { return MD5Sum<Message>::value(); }
  static const char* value(const kinescope::ros_bridge::BoundedMessage<Message>&) {
    return value();
  }
};
template <class Message>
struct DataType<kinescope::ros_bridge::BoundedMessage<Message>> {
  static const char* value() { return DataType<Message>::value(); }
  static const char* value(const kinescope::ros_bridge::BoundedMessage<Message>&) {
    return value();
  }
};
template <class Message>
struct Definition<kinescope::ros_bridge::BoundedMessage<Message>> {
  static const char* value() { return Definition<Message>::value(); }
  static const char* value(const kinescope::ros_bridge::BoundedMessage<Message>&) {
    return value();
  }
};
}  // namespace message_traits
namespace serialization {
template <class Message>
struct Serializer<kinescope::ros_bridge::BoundedMessage<Message>> {
  template <class Stream>
  static void read(Stream& stream, kinescope::ros_bridge::BoundedMessage<Message>& bounded) {
    bounded.is_sound =
        kinescope::ros_bridge::ReadBounded(stream.getData(), stream.getLength(), bounded.message);
  }
};
template <>
struct Serializer<kinescope::ros_bridge::RawMessage> {
  template <class Stream>
  static void read(Stream& stream, kinescope::ros_bridge::RawMessage& message) {
    message.bytes.assign(stream.getData(), stream.getData() + stream.getLength());
  }
};
}  // namespace serialization
namespace service_traits {
template <class Request>
struct MD5Sum<kinescope::ros_bridge::BoundedMessage<Request>> {
  static const char* value() { return MD5Sum<Request>::value(); }
};
template <class Request>
struct DataType<kinescope::ros_bridge::BoundedMessage<Request>> {
  static const char* value() { return DataType<Request>::value(); }
};
}  // namespace service_traits
}  // namespace ros
