/// The pinhole camera of a calibration (sensor_msgs/CameraInfo), as RViz takes it: without
/// distortion, by the projection matrix P. Pure functions, any thread.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera_image.h"
#include "server/ros/force_input.h"

namespace kinescope::ros_bridge {

struct Calibration {
  std::string frame;  // of TF
  /// Its pose is that in `frame`, where the second camera of a stereo pair is beside the first.
  ImageCamera camera;
};

[[nodiscard]] bool IsCalibrationType(const std::string& md5sum);

/// Of a message whose P is not set, by K, which is the same for an image without distortion.
Taken<Calibration> ToCalibration(const sensor_msgs::CameraInfo& message);
/// The same, of a serialised message.
Taken<Calibration> ReadCalibration(const std::vector<std::uint8_t>& bytes);

/// Where image_transport expects the calibration of an image: "/camera/camera_info" for
/// "/camera/image_raw", and for its transport "/camera/image_raw/compressed".
std::string CalibrationTopicOf(const std::string& image_topic);

}  // namespace kinescope::ros_bridge
