#include "server/ros/raw_message.h"

#include <cmath>
#include <cstring>

namespace kinescope::ros_bridge {
namespace {

constexpr double kFarthest = 1e6;  // m; beyond any plausible position
constexpr double kNormTolerance = 1e-3;

// The smallest size of a list element: with empty strings.
constexpr std::size_t kHeader = 4 + 8 + 4;  // sequence, stamp, frame_id
constexpr std::size_t kSmallestTransform = kHeader + 4 + 7 * 8;
constexpr std::size_t kSmallestLinkState = kHeader + (7 + 6 + 6) * 8;

std::uint32_t CountAt(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + at, sizeof(count));  // little-endian, as this machine
  return count;
}

// Whether the list whose count is at `at` fits into the bytes after it.
bool ListFits(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t smallest) {
  if (bytes.size() > kLargestMessage || bytes.size() < at + sizeof(std::uint32_t)) return false;
  return CountAt(bytes, at) <= (bytes.size() - at - sizeof(std::uint32_t)) / smallest;
}

// Walks through a message without storing it; false once an element does not fit.
class Walker {
 public:
  explicit Walker(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  bool Skip(std::size_t size) {
    if (size > bytes_.size() - at_) return false;
    at_ += size;
    return true;
  }
  bool Count(std::uint32_t& count) {
    if (bytes_.size() - at_ < sizeof(count)) return false;
    count = CountAt(bytes_, at_);
    at_ += sizeof(count);
    return true;
  }
  bool SkipList(std::size_t element) {  // a string is a list of bytes
    std::uint32_t count = 0;
    return Count(count) && Skip(count * element);
  }
  bool SkipMarker() {
    constexpr std::size_t kToPoints =  // number, type, action, pose, scale, color, lifetime, locked
        3 * 4 + 7 * 8 + 3 * 8 + 4 * 4 + 8 + 1;
    const bool has_head = Skip(4 + 8) && SkipList(1) && SkipList(1) && Skip(kToPoints);
    return has_head && SkipList(3 * 8) && SkipList(4 * 4) && SkipList(1) && SkipList(1) && Skip(1);
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

template <class Message>
bool Deserialize(const std::vector<std::uint8_t>& bytes, Message& message) {
  try {
    // Only reads, but requires writable bytes.
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

bool Decode(const std::vector<std::uint8_t>& bytes, visualization_msgs::Marker& message) {
  return bytes.size() <= kLargestMessage && Walker(bytes).SkipMarker() &&
         Deserialize(bytes, message);
}

bool Decode(const std::vector<std::uint8_t>& bytes, visualization_msgs::MarkerArray& message) {
  if (bytes.size() > kLargestMessage) return false;
  Walker walker(bytes);
  std::uint32_t count = 0;
  if (!walker.Count(count)) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!walker.SkipMarker()) return false;
  }
  return Deserialize(bytes, message);
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
