#include "server/ros/calibration.h"

#include <ros/message_traits.h>

#include <array>

#include "core/scene_marker.h"
#include "server/ros/image_box.h"
#include "server/ros/image_messages.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {

bool IsCalibrationType(const std::string& md5sum) {
  return md5sum == ros::message_traits::md5sum<sensor_msgs::CameraInfo>();
}

Taken<Calibration> ToCalibration(const sensor_msgs::CameraInfo& message) {
  Calibration calibration;
  calibration.frame = WithoutSlash(message.header.frame_id);
  ImageCamera& camera = calibration.camera;
  camera.width = Side(message.width);
  camera.height = Side(message.height);
  const bool has_p = message.P[0] != 0;
  camera.focal_px = has_p ? std::array<double, 2>{message.P[0], message.P[5]}
                          : std::array<double, 2>{message.K[0], message.K[4]};
  camera.center_px = has_p ? std::array<double, 2>{message.P[2], message.P[6]}
                           : std::array<double, 2>{message.K[2], message.K[5]};
  const auto refuse = [](const std::string& why) {
    return tl::unexpected(Refusal{"a calibration that cannot be used", "camera_info: " + why});
  };
  if (const std::string defect = FindDefect(camera); !defect.empty()) return refuse(defect);
  const Eigen::Vector3d beside(-message.P[3] / camera.focal_px[0],
                               -message.P[7] / camera.focal_px[1], 0);
  if (!has_p) return calibration;
  if (!(beside.cwiseAbs().maxCoeff() < kFarthestMarker)) return refuse("its place is far away");
  camera.world_from_optical.position = beside;
  return calibration;
}

Taken<Calibration> ReadCalibration(const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::CameraInfo info;
  if (!ReadBounded(bytes.data(), bytes.size(), info)) return tl::unexpected(Unreadable());
  return ToCalibration(info);
}

std::string CalibrationTopicOf(const std::string& image_topic) {
  const std::string image = WithoutTransport(image_topic);
  const std::size_t slash = image.rfind('/');
  return image.substr(0, slash == std::string::npos ? 0 : slash + 1) + "camera_info";
}

}  // namespace kinescope::ros_bridge
