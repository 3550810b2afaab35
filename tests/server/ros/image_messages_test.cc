#include "server/ros/image_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include "server/ros/image_box.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

template <class Message>
Taken<CameraImage> Read(const Message& message, std::size_t cut = 0) {
  auto bytes =
      std::make_shared<std::vector<std::uint8_t>>(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes->data(), static_cast<std::uint32_t>(bytes->size()));
  ros::serialization::serialize(out, message);
  bytes->resize(bytes->size() - cut);
  return ReadImage(ros::message_traits::md5sum<Message>(), bytes);
}

sensor_msgs::Image SomeImage() {
  sensor_msgs::Image message;
  message.header.frame_id = "camera";
  message.width = 2;
  message.height = 1;
  message.encoding = "rgb8";
  message.step = 6;
  message.data = {1, 2, 3, 4, 5, 6};
  return message;
}

TEST(ImageMessages, AreReadWithoutACopyOfTheirPixels) {
  const auto image = Read(SomeImage());
  ASSERT_TRUE(image) << image.error().text;
  EXPECT_EQ(image->width, 2);
  EXPECT_EQ(image->height, 1);
  EXPECT_EQ(image->encoding, "rgb8");
  EXPECT_EQ(image->row_bytes, 6u);
  EXPECT_EQ(image->size, 6u);
  EXPECT_EQ(image->bytes->at(image->begin), 1);
  EXPECT_EQ(image->bytes->at(image->begin + 5), 6);
}

TEST(ImageMessages, ThatAreTruncatedAreRefused) {
  const sensor_msgs::Image message = SomeImage();
  const std::size_t size = ros::serialization::serializationLength(message);
  for (std::size_t cut = 1; cut <= size; ++cut) EXPECT_FALSE(Read(message, cut)) << cut;
}

TEST(ImageMessages, ThatLieAreRefused) {
  sensor_msgs::Image message = SomeImage();
  message.height = 2;
  EXPECT_EQ(Read(message).error().text, "an image: it states more pixels than it has");
  message = SomeImage();
  message.width = 0xFFFFFFFF;
  EXPECT_THAT(Read(message).error().text, HasSubstr("an image: 2147483647 x 1 px"));
  message = SomeImage();
  message.encoding = "unheard_of";
  EXPECT_THAT(Read(message).error().text, HasSubstr("encoding 'unheard_of'"));
}

TEST(ImageMessages, MayBeJpegOrPngAndNothingElseThatIsCompressed) {
  sensor_msgs::CompressedImage message;
  message.format = "rgb8; jpeg compressed bgr8";
  message.data = {0xff, 0xd8, 0xff, 0xe0, 0};
  const auto image = Read(message);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->encoding, "jpeg");
  EXPECT_EQ(image->size, 5u);
  message.data = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0};
  EXPECT_EQ(Read(message)->encoding, "png") << "whatever its format says";
  message.data.resize(6);
  EXPECT_EQ(Read(message).error().text, "a compressed image that is neither JPEG nor PNG");
  message.data.clear();
  EXPECT_FALSE(Read(message));
  EXPECT_TRUE(IsImageType(ros::message_traits::md5sum<sensor_msgs::CompressedImage>()));
  EXPECT_FALSE(IsImageType(ros::message_traits::md5sum<std_msgs::String>()));
}

TEST(ImageMessages, MayBeADepthWithItsHead) {
  sensor_msgs::CompressedImage message;
  message.format = "16UC1; compressedDepth png";
  message.data.resize(12);
  for (const std::uint8_t byte : {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x07}) {
    message.data.push_back(byte);
  }
  const auto image = Read(message);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->encoding, "png");
  EXPECT_EQ(image->size, 9u);
  EXPECT_EQ(image->bytes->at(image->begin), 0x89);
  message.format = "32FC1; compressedDepth png";
  EXPECT_THAT(Read(message).error().text, HasSubstr("not of 16UC1"));
  message.format = "16UC1; compressedDepth";
  message.data.resize(11);
  EXPECT_FALSE(Read(message));
}

TEST(ImageBox, HasTheNewestOfEachTopicAndFourAtMost) {
  ImageBox box;
  EXPECT_FALSE(box.TakeChanged());
  for (std::size_t topic = 0; topic < 6; ++topic) {
    const auto refusal = box.Put(topic, *Read(SomeImage()));
    EXPECT_EQ(refusal.has_value(), topic >= 4) << topic;
  }
  CameraImage newer = *Read(SomeImage());
  newer.name = "newer";
  EXPECT_FALSE(box.Put(1, newer));
  ASSERT_THAT(box.images(), SizeIs(4));
  EXPECT_EQ(box.images()[1]->name, "newer");
  EXPECT_TRUE(box.TakeChanged());
  EXPECT_FALSE(box.TakeChanged());
}

TEST(ImageBox, CallsCamerasAsTheirTopics) {
  EXPECT_EQ(NameOfCamera("/camera/image_raw"), "camera/image_raw");
  EXPECT_EQ(NameOfCamera("/camera/image_raw/compressed"), "camera/image_raw");
  EXPECT_EQ(NameOfCamera("/compressed"), "compressed");
}

}  // namespace
}  // namespace kinescope::ros_bridge
