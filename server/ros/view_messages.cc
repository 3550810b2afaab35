#include "server/ros/view_messages.h"

#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>

#include "core/system/check.h"
#include "server/ros/convert.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {

std::string OpticalFrame(const std::string& view) {
  std::string frame = view.substr(view.find_first_not_of('/'));
  std::replace(frame.begin(), frame.end(), '/', '_');
  return frame + "_camera_optical";
}

void FillImage(const RosImage& picture, const std::string& frame, sensor_msgs::Image& message) {
  const auto pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  KINESCOPE_CHECK(picture.rgba.size() == 4 * pixels);
  message.header.stamp = ToRosTime(picture.stamp_nanos);
  message.header.frame_id = frame;
  message.width = static_cast<std::uint32_t>(picture.width);
  message.height = static_cast<std::uint32_t>(picture.height);
  message.encoding = sensor_msgs::image_encodings::RGB8;
  message.is_bigendian = 0;
  message.step = 3 * message.width;
  message.data.resize(3 * pixels);
  const std::uint8_t* from = picture.rgba.data();
  std::uint8_t* to = message.data.data();
  for (std::size_t i = 0; i < pixels; ++i, from += 4, to += 3) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
  }
}

void FillCameraInfo(const RosImage& picture, const std::string& frame,
                    sensor_msgs::CameraInfo& message) {
  message.header.stamp = ToRosTime(picture.stamp_nanos);
  message.header.frame_id = frame;
  message.width = static_cast<std::uint32_t>(picture.width);
  message.height = static_cast<std::uint32_t>(picture.height);
  message.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  message.D.assign(5, 0.0);
  message.K.fill(0);
  message.P.fill(0);
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (!(picture.focal_px > 0)) return;
  const double f = picture.focal_px;
  const double cx = (picture.width - 1) / 2.0, cy = (picture.height - 1) / 2.0;
  message.K = {f, 0, cx, 0, f, cy, 0, 0, 1};
  message.P = {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0};
}

void FillCameraFrame(const RosImage& picture, const std::string& reference_frame,
                     const std::string& frame, geometry_msgs::TransformStamped& message) {
  message.header.stamp = ToRosTime(picture.stamp_nanos);
  message.header.frame_id = reference_frame;
  message.child_frame_id = frame;
  Set(message.transform.translation, picture.world_from_optical.position);
  Set(message.transform.rotation, picture.world_from_optical.orientation);
}

}  // namespace kinescope::ros_bridge
