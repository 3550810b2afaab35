/// The server's own view as messages: picture, camera and the camera's frame. Pure: no node, no
/// clock. All three of one picture carry one stamp.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

/// The frame that pictures of the topic namespace `view` ("/kinescope/view") are taken in: a name
/// that no other node of the graph has, "kinescope_view_camera_optical" (REP 103: z forward, x to
/// the right, y down).
std::string OpticalFrame(const std::string& view);

/// rgb8; what is below an opaque picture is nothing, so alpha says nothing. `message` keeps its
/// memory from picture to picture.
void FillImage(const ViewPicture& picture, const std::string& frame, sensor_msgs::Image& message);

/// K and P of a pinhole without distortion (plumb_bob, five zeros), for pixels whose centres are at
/// whole numbers, as sensor_msgs/CameraInfo and OpenCV have them: the axis of a picture w wide
/// meets it at (w - 1) / 2. K is zero, which is to say "not calibrated", where the picture is none
/// of a pinhole camera.
void FillCameraInfo(const ViewPicture& picture, const std::string& frame,
                    sensor_msgs::CameraInfo& message);

/// reference_frame <- `frame`.
void FillCameraFrame(const ViewPicture& picture, const std::string& reference_frame,
                     const std::string& frame, geometry_msgs::TransformStamped& message);

}  // namespace kinescope::ros_bridge
