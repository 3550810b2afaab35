#include "server/ros/view_messages.h"

#include <gtest/gtest.h>

namespace kinescope::ros_bridge {
namespace {

const std::vector<std::uint8_t>& Pixels() {  // 3 x 2
  static const std::vector<std::uint8_t> rgba = {1,  2,  3,  255, 4,  5,  6,  255, 7,  8,  9,  255,
                                                 10, 11, 12, 255, 13, 14, 15, 255, 16, 17, 18, 255};
  return rgba;
}

RosImage Picture() { return {3, 2, Pixels(), 1'500'000'000, {{1, 2, 3}, {}}, 40}; }

TEST(ViewMessages, ContainThePixelsInOrderWithoutAlpha) {
  sensor_msgs::Image image;
  FillImage(Picture(), "eye", image);
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.encoding, "rgb8");
  EXPECT_EQ(image.step, 9u);
  for (std::size_t i = 0; i < 18; ++i) ASSERT_EQ(image.data.at(i), i + 1);
  EXPECT_EQ(image.data.size(), 18u);
}

TEST(ViewMessages, HaveOneTimeStampAndFrame) {
  sensor_msgs::Image image;
  sensor_msgs::CameraInfo info;
  geometry_msgs::TransformStamped frame;
  FillImage(Picture(), "eye", image);
  FillCameraInfo(Picture(), "eye", info);
  FillCameraFrame(Picture(), "world", "eye", frame);
  EXPECT_EQ(image.header.stamp, ros::Time(1, 500'000'000));
  EXPECT_EQ(info.header.stamp, image.header.stamp);
  EXPECT_EQ(frame.header.stamp, image.header.stamp);
  EXPECT_EQ(image.header.frame_id, "eye");
  EXPECT_EQ(info.header.frame_id, "eye");
  EXPECT_EQ(frame.child_frame_id, "eye");
  EXPECT_EQ(frame.header.frame_id, "world");
  EXPECT_EQ(frame.transform.translation.z, 3);
}

TEST(ViewMessages, ContainACalibrationOnlyForPinholeCameras) {
  sensor_msgs::CameraInfo info;
  FillCameraInfo(Picture(), "eye", info);
  EXPECT_EQ(info.K[0], 40);
  EXPECT_EQ(info.K[2], 1);    // the middle one of three pixels
  EXPECT_EQ(info.P[6], 0.5);  // between the two rows
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, std::vector<double>(5, 0.0));
  const RosImage flat{3, 2, Pixels(), 0, {}, 0};
  FillCameraInfo(flat, "eye", info);
  EXPECT_EQ(info.K[0], 0);
  EXPECT_EQ(info.P[10], 0);
}

TEST(ViewMessages, HaveDifferentFramesForDifferentNodes) {
  EXPECT_EQ(OpticalFrame("/kinescope/view"), "kinescope_view_camera_optical");
  EXPECT_EQ(OpticalFrame("/lab/kinescope/view"), "lab_kinescope_view_camera_optical");
}

}  // namespace
}  // namespace kinescope::ros_bridge
