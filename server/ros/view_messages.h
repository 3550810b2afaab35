/// Converts the rendered view to messages: picture, camera and frame of the camera. Pure: no node,
/// no clock; any thread. All three of one picture have the same stamp.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

/// The camera frame of the pictures of the topic namespace `view` ("/kinescope/view"):
/// "kinescope_view_camera_optical", unique in the graph (REP 103: z forward, x to the right, y
/// down).
std::string OpticalFrame(const std::string& view);

/// rgb8; alpha is dropped, because the picture is opaque. `message` keeps its memory from picture
/// to picture.
void FillImage(const RosImage& picture, const std::string& frame, sensor_msgs::Image& message);

/// K and P of a pinhole camera without distortion (plumb_bob, five zeros), with pixel centres at
/// whole numbers, as in sensor_msgs/CameraInfo and OpenCV: in a picture of width w the axis is at
/// (w - 1) / 2. K is zero ("not calibrated") if the picture is not of a pinhole camera.
void FillCameraInfo(const RosImage& picture, const std::string& frame,
                    sensor_msgs::CameraInfo& message);

/// reference_frame <- `frame`.
void FillCameraFrame(const RosImage& picture, const std::string& reference_frame,
                     const std::string& frame, geometry_msgs::TransformStamped& message);

}  // namespace kinescope::ros_bridge
