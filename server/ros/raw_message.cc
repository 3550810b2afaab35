#include "server/ros/raw_message.h"

#include <cmath>

namespace kinescope::ros_bridge {
namespace {

constexpr double kFarthestTransform = 1e6;  // m; beyond any plausible position
constexpr double kNormTolerance = 1e-3;

}  // namespace

std::string Said(const RawEvent& event, const char* key) {
  const ros::M_string& connection = event.getConnectionHeader();
  const auto found = connection.find(key);
  return found == connection.end() ? std::string() : found->second;
}

bool Decode(const std::vector<std::uint8_t>& bytes, tf2_msgs::TFMessage& message) {
  return ReadBounded(bytes.data(), bytes.size(), message);
}

bool Decode(const std::vector<std::uint8_t>& bytes, xsens_mvn_ros_msgs::LinkStateArray& message) {
  return ReadBounded(bytes.data(), bytes.size(), message);
}

bool Decode(const std::vector<std::uint8_t>& bytes, visualization_msgs::Marker& message) {
  return ReadBounded(bytes.data(), bytes.size(), message);
}

bool Decode(const std::vector<std::uint8_t>& bytes, visualization_msgs::MarkerArray& message) {
  return ReadBounded(bytes.data(), bytes.size(), message);
}

const char* DefectOf(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw) {
  if (!position.allFinite() || !xyzw.allFinite()) {
    return "transform with a number that is not finite";
  }
  if (position.cwiseAbs().maxCoeff() > kFarthestTransform)
    return "transform with a position out of range";
  return std::abs(xyzw.norm() - 1) > kNormTolerance
             ? "transform with a quaternion that is not of unit length"
             : nullptr;
}

std::string WithoutSlash(const std::string& frame) {
  return frame.empty() || frame.front() != '/' ? frame : frame.substr(1);
}

}  // namespace kinescope::ros_bridge
