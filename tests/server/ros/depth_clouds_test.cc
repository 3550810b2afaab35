// Images of depths as points: where RViz has them, coloured, and no more than are shown.
#include "server/ros/depth_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using visualization_msgs::Marker;

constexpr std::uint32_t kWide = 8, kHigh = 6;

template <class Message>
std::vector<std::uint8_t> MessageBytes(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

sensor_msgs::CameraInfo InfoOf(std::uint32_t scale) {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = "another_frame";
  info.width = scale * kWide;
  info.height = scale * kHigh;
  info.P = {scale * 10.0, 0, scale * 3.0, 0, 0, scale * 10.0, scale * 2.0, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::Image ImageOf(const std::string& encoding, std::size_t bytes_per_pixel) {
  sensor_msgs::Image image;
  image.header.frame_id = "depth";
  image.width = kWide;
  image.height = kHigh;
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(kWide * bytes_per_pixel);
  image.data.resize(image.step * kHigh);
  return image;
}

// 2 m everywhere.
sensor_msgs::Image Millimetres() {
  sensor_msgs::Image image = ImageOf("16UC1", 2);
  for (std::size_t i = 0; i < image.data.size(); i += 2) {
    image.data[i] = 2000 & 255;
    image.data[i + 1] = 2000 >> 8;
  }
  return image;
}

class DepthCloudsTest : public ::testing::Test {
 protected:
  DepthCloudsTest() { style_.camera.is_cloud = true; }

  template <class Message>
  std::optional<Refusal> Take(const Message& message, ShownMarkers& markers) {
    const std::string type = ros::message_traits::md5sum<Message>();
    EXPECT_TRUE(TopicMarkers::IsShown(type, style_));
    markers.clear();
    return topics_.Take(0, "/depth/image", style_, type, MessageBytes(message), markers);
  }
  // Points of a message that is taken.
  template <class Message>
  Marker PointsOf(const Message& message) {
    ShownMarkers markers;
    const auto refusal = Take(message, markers);
    EXPECT_FALSE(refusal) << refusal->text;
    return markers.empty() ? Marker() : markers.front();
  }
  template <class Message>
  std::string WhyNot(const Message& message) {
    ShownMarkers markers;
    const auto refusal = Take(message, markers);
    return refusal ? refusal->text : "";
  }
  std::optional<Refusal> TakeColors(const sensor_msgs::Image& image) {
    return topics_.TakeColors(0, ros::message_traits::md5sum<sensor_msgs::Image>(),
                              MessageBytes(image));
  }

  ShownStyle style_;
  TopicMarkers topics_;
};

TEST_F(DepthCloudsTest, ArePointsAheadOfTheirPixels) {
  EXPECT_THAT(WhyNot(Millimetres()), HasSubstr("no calibration"));
  EXPECT_THAT(PointsOf(InfoOf(1)).points, IsEmpty());
  const Marker points = PointsOf(Millimetres());
  EXPECT_EQ(points.type, Marker::POINTS);
  EXPECT_EQ(points.ns, "depth/image");
  EXPECT_EQ(points.header.frame_id, "depth");
  ASSERT_THAT(points.points, SizeIs(kWide * kHigh));
  EXPECT_NEAR(points.points[0].x, -3 / 10.0 * 2, 1e-6);
  EXPECT_NEAR(points.points[0].y, -2 / 10.0 * 2, 1e-6);
  EXPECT_NEAR(points.points[0].z, 2, 1e-6);
  EXPECT_NEAR(points.points.back().x, (7 - 3) / 10.0 * 2, 1e-6);
  EXPECT_NEAR(points.points.back().y, (5 - 2) / 10.0 * 2, 1e-6);
  EXPECT_NEAR(points.scale.x, 2 / 10.0, 1e-6) << "a pixel";
}

TEST_F(DepthCloudsTest, MayBeCalibratedForALargerImage) {
  PointsOf(InfoOf(4));
  const Marker points = PointsOf(Millimetres());
  EXPECT_NEAR(points.points[0].x, -3 / 10.0 * 2, 1e-6);
  EXPECT_NEAR(points.points.back().y, (5 - 2) / 10.0 * 2, 1e-6);
}

TEST_F(DepthCloudsTest, MayBeInMetresAndOfEitherByteOrderAndHaveHoles) {
  PointsOf(InfoOf(1));
  sensor_msgs::Image big = Millimetres();
  big.is_bigendian = 1;
  for (std::size_t i = 0; i < big.data.size(); i += 2) std::swap(big.data[i], big.data[i + 1]);
  EXPECT_NEAR(PointsOf(big).points.at(5).z, 2, 1e-6);
  sensor_msgs::Image metres = ImageOf("32FC1", 4);
  const std::vector<float> depths = {1.5F, std::numeric_limits<float>::quiet_NaN(), 0, -1,
                                     std::numeric_limits<float>::infinity()};
  for (std::size_t i = 0; i < depths.size(); ++i) {
    std::memcpy(&metres.data[4 * i], &depths[i], 4);
  }
  const Marker points = PointsOf(metres);
  ASSERT_THAT(points.points, SizeIs(1));
  EXPECT_NEAR(points.points[0].z, 1.5, 1e-6);
  sensor_msgs::Image none = ImageOf("16UC1", 2);
  EXPECT_EQ(PointsOf(none).action, Marker::DELETE);
}

TEST_F(DepthCloudsTest, HaveTheColoursOfAnImageOfTheSameSize) {
  PointsOf(InfoOf(1));
  sensor_msgs::Image colors = ImageOf("bgr8", 3);
  colors.data[3] = 255;  // the second pixel is blue
  EXPECT_FALSE(TakeColors(colors));
  const Marker points = PointsOf(Millimetres());
  ASSERT_THAT(points.colors, SizeIs(kWide * kHigh));
  EXPECT_EQ(points.colors[1].b, 1);
  EXPECT_EQ(points.colors[1].r, 0);
  EXPECT_EQ(points.colors[0].b, 0);
  sensor_msgs::Image small = ImageOf("bgr8", 3);
  small.height = 1;
  EXPECT_FALSE(TakeColors(small));
  EXPECT_THAT(WhyNot(Millimetres()), HasSubstr("of its colours has another size"));
  EXPECT_THAT(TakeColors(Millimetres())->text, HasSubstr("expected rgb8"));
}

TEST_F(DepthCloudsTest, OfManyPixelsAreThoseOfEveryNthRowAndColumn) {
  PointsOf(InfoOf(1));
  style_.most_points = 12;
  const Marker points = PointsOf(Millimetres());
  ASSERT_THAT(points.points, SizeIs(4 * 3));
  EXPECT_NEAR(points.points[1].x - points.points[0].x, 2 * 2 / 10.0, 1e-6);
  EXPECT_NEAR(points.scale.x, 2 * 2 / 10.0, 1e-6) << "closed";
  style_.size_m = 0.05;
  EXPECT_NEAR(PointsOf(Millimetres()).scale.x, 0.05, 1e-6);
}

TEST_F(DepthCloudsTest, ThatAreNoneAreRefused) {
  PointsOf(InfoOf(1));
  EXPECT_THAT(WhyNot(ImageOf("rgb8", 3)), HasSubstr("expected 16UC1 or 32FC1"));
  sensor_msgs::CompressedImage png;
  png.format = "16UC1; compressedDepth";
  png.data.resize(12);
  for (const std::uint8_t byte : {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0}) {
    png.data.push_back(byte);
  }
  EXPECT_THAT(WhyNot(png), HasSubstr("expected 16UC1 or 32FC1"));
  sensor_msgs::CameraInfo info = InfoOf(1);
  info.P[0] = -1;
  EXPECT_THAT(WhyNot(info), HasSubstr("focal lengths"));
  EXPECT_THAT(PointsOf(Millimetres()).points, SizeIs(kWide * kHigh)) << "the last good one holds";
}

}  // namespace
}  // namespace kinescope::ros_bridge
