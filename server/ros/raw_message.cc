#include "server/ros/raw_message.h"

#include <cmath>
#include <cstring>

namespace kinescope::ros_bridge {
namespace {

constexpr double kFarthest = 1e6;  // m; nobody stands there
constexpr double kNormTolerance = 1e-3;

// What an element of a list takes at least: every string in it empty.
constexpr std::size_t kHeader = 4 + 8 + 4;  // sequence, stamp, frame_id
constexpr std::size_t kSmallestTransform = kHeader + 4 + 7 * 8;
constexpr std::size_t kSmallestLinkState = kHeader + (7 + 6 + 6) * 8;

std::uint32_t CountAt(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + at, sizeof(count));  // little-endian, as this machine is
  return count;
}

// Whether the list whose count is at `at` fits into what follows it.
bool ListFits(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t smallest) {
  if (bytes.size() > kLargestMessage || bytes.size() < at + sizeof(std::uint32_t)) return false;
  return CountAt(bytes, at) <= (bytes.size() - at - sizeof(std::uint32_t)) / smallest;
}

template <class Message>
bool Deserialize(const std::vector<std::uint8_t>& bytes, Message& message) {
  try {
    // Only reads, but asks for bytes that it could write to.
    ros::serialization::IStream in(const_cast<std::uint8_t*>(bytes.data()),
                                   static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::deserialize(in, message);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

}  // namespace

bool Decode(const std::vector<std::uint8_t>& bytes, tf2_msgs::TFMessage& message) {
  return ListFits(bytes, 0, kSmallestTransform) && Deserialize(bytes, message);
}

bool Decode(const std::vector<std::uint8_t>& bytes, xsens_mvn_ros_msgs::LinkStateArray& message) {
  if (bytes.size() < kHeader) return false;
  const std::size_t name = CountAt(bytes, kHeader - sizeof(std::uint32_t));
  return name <= bytes.size() - kHeader && ListFits(bytes, kHeader + name, kSmallestLinkState) &&
         Deserialize(bytes, message);
}

const char* DefectOf(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw) {
  if (!position.allFinite() || !xyzw.allFinite()) {
    return "transform with a number that is not finite";
  }
  if (position.cwiseAbs().maxCoeff() > kFarthest) return "transform with a position out of range";
  return std::abs(xyzw.norm() - 1) > kNormTolerance
             ? "transform with a quaternion that is not of unit length"
             : nullptr;
}

std::string WithoutSlash(const std::string& frame) {
  return frame.empty() || frame.front() != '/' ? frame : frame.substr(1);
}

}  // namespace kinescope::ros_bridge
