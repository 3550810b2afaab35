#include "server/ros/image_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "server/ros/calibration.h"
#include "server/ros/image_box.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
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
  message.data.resize(16);
  for (const std::uint8_t byte : {0, 0, 0x1f, 0x40, 0, 0, 0x17, 0x70}) message.data.push_back(byte);
  EXPECT_EQ(Read(message).error().text,
            "a PNG of 8000 x 6000 px; at most 16777216 px are unpacked");
  message.data[18] = 0x0a;
  EXPECT_TRUE(Read(message));
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

sensor_msgs::CameraInfo SomeCalibration() {
  sensor_msgs::CameraInfo message;
  message.header.frame_id = "/eye";
  message.width = 640;
  message.height = 480;
  message.K = {500, 0, 300, 0, 510, 200, 0, 0, 1};
  message.P = {525, 0, 319.5, 0, 0, 520, 239.5, 0, 0, 0, 1, 0};
  return message;
}

TEST(Calibration, IsTheProjectionOfTheImageThatIsShown) {
  const auto calibration = ToCalibration(SomeCalibration());
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_EQ(calibration->frame, "eye");
  EXPECT_EQ(calibration->camera.width, 640);
  EXPECT_EQ(calibration->camera.focal_px, (std::array<double, 2>{525, 520}));
  EXPECT_EQ(calibration->camera.center_px, (std::array<double, 2>{319.5, 239.5}));
  EXPECT_EQ(calibration->camera.world_from_optical.position, Eigen::Vector3d::Zero());
  sensor_msgs::CameraInfo right = SomeCalibration();  // of a stereo pair, 12 cm beside the left one
  right.P[3] = -0.12 * 525;
  EXPECT_TRUE(ToCalibration(right)->camera.world_from_optical.position.isApprox(
      Eigen::Vector3d(0.12, 0, 0)));
  sensor_msgs::CameraInfo no_p = SomeCalibration();
  no_p.P.assign(0);
  EXPECT_EQ(ToCalibration(no_p)->camera.focal_px, (std::array<double, 2>{500, 510}));
  EXPECT_EQ(ToCalibration(no_p)->camera.center_px, (std::array<double, 2>{300, 200}));
}

TEST(Calibration, ThatIsNoneIsRefused) {
  sensor_msgs::CameraInfo message = SomeCalibration();
  message.P[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ToCalibration(message).error().text, "camera_info: its focal lengths are not positive");
  message = SomeCalibration();
  message.P[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ToCalibration(message).error().text, "camera_info: its place is far away");
  message = {};
  EXPECT_EQ(ToCalibration(message).error().text, "camera_info: it was calibrated for 0 x 0 px");
}

TEST(Calibration, IsExpectedBesideTheImage) {
  EXPECT_EQ(CalibrationTopicOf("/camera/image_raw"), "/camera/camera_info");
  EXPECT_EQ(CalibrationTopicOf("/camera/image_raw/compressed"), "/camera/camera_info");
  EXPECT_EQ(CalibrationTopicOf("/image"), "/camera_info");
  EXPECT_EQ(CalibrationTopicOf("image"), "camera_info");
}

TEST(TopicsHeardFor, AreThoseBesideAnImageThatItNeeds) {
  const auto names_of = [](const ShownTopic& topic) {
    std::vector<std::string> names;
    for (const HeardTopic& heard : TopicsHeardFor(topic)) {
      names.push_back(heard.name + (heard.has_colors ? " (colours)" : ""));
    }
    return names;
  };
  ShownTopic topic{"/eye/image_raw"};
  EXPECT_THAT(names_of(topic), ElementsAre("/eye/image_raw"));
  topic.style.camera.scene_opacity = 0.5;
  EXPECT_THAT(names_of(topic), ElementsAre("/eye/image_raw", "/eye/camera_info"));
  topic.style.camera = {0, 0, true, "/rgb/image"};
  EXPECT_THAT(names_of(topic),
              ElementsAre("/eye/image_raw", "/eye/camera_info", "/rgb/image (colours)"));
  EXPECT_THAT(names_of({"/goals/update"}), ElementsAre("/goals/update", "/goals/update_full"));
  ShownTopic map{"/map"};
  EXPECT_THAT(names_of(map), ElementsAre("/map"));
  map.style.has_updates = true;
  EXPECT_THAT(names_of(map), ElementsAre("/map", "/map_updates"));
}

// Its camera is at x = 1 at the time 5 s, and at x = 2 now.
std::optional<FramePlace> MovingEye(const std::string& frame, std::int64_t stamp_nanos) {
  if (frame != "eye") return std::nullopt;
  if (stamp_nanos != 0 && stamp_nanos != 5'000'000'000) return std::nullopt;
  urdf::Pose pose;
  pose.position.x() = stamp_nanos == 0 ? 2 : 1;
  return FramePlace{pose};
}

CameraImage TakenAt(std::int64_t stamp_nanos) {
  CameraImage image = *Read(SomeImage());
  image.stamp_nanos = stamp_nanos;
  return image;
}

TEST(ImageBox, PlacesTheCameraAtTheTimeOfItsImage) {
  ImageBox box;
  EXPECT_FALSE(box.Put(3, TakenAt(5'000'000'000), {0.5}));
  box.Update(1, MovingEye);
  EXPECT_FALSE(box.images()[0]->camera) << "no calibration yet";
  box.PutCalibration(3, *ToCalibration(SomeCalibration()));
  EXPECT_TRUE(box.TakeChanged());
  box.Update(20'000'000, MovingEye);
  ASSERT_TRUE(box.images()[0]->camera);
  EXPECT_EQ(box.images()[0]->camera->world_from_optical.position.x(), 1);
  EXPECT_EQ(box.images()[0]->camera->scene_opacity, 0.5);
  EXPECT_EQ(box.images()[0]->camera->focal_px[0], 525);
  EXPECT_TRUE(box.TakeChanged());
  const auto shown = box.images()[0];
  box.Update(40'000'000, MovingEye);
  EXPECT_EQ(box.images()[0], shown);
  EXPECT_FALSE(box.TakeChanged());
  // Of the next one TF does not know the time.
  EXPECT_FALSE(box.Put(3, TakenAt(6'000'000'000), {0.5}));
  EXPECT_EQ(box.images()[0]->camera->world_from_optical.position.x(), 1) << "as before";
  box.Update(60'000'000, MovingEye);
  EXPECT_EQ(box.images()[0]->camera->world_from_optical.position.x(), 2);
  EXPECT_THAT(box.TakeLost(), IsEmpty());
}

TEST(ImageBox, PlacesTheCameraAgainOnceItsTimeIsKnown) {
  ImageBox box;
  EXPECT_FALSE(box.Put(3, TakenAt(5'000'000'000), {0.5}));
  box.PutCalibration(3, *ToCalibration(SomeCalibration()));
  FramePlace eye;
  const auto find = [&](const std::string&, std::int64_t) { return std::make_optional(eye); };
  eye.is_early = true;
  box.Update(20'000'000, find);
  ASSERT_TRUE(box.images()[0]->camera);
  eye = {{{7, 0, 0}, Eigen::Quaterniond::Identity()}, false};
  box.Update(40'000'000, find);
  EXPECT_EQ(box.images()[0]->camera->world_from_optical.position.x(), 7);
  eye.pose.position.x() = 8;
  box.Update(60'000'000, find);
  EXPECT_EQ(box.images()[0]->camera->world_from_optical.position.x(), 7) << "at its own time";
}

TEST(ImageBox, NeedsNoCameraForAnImageWithoutTheScene) {
  ImageBox box;
  box.PutCalibration(0, *ToCalibration(SomeCalibration()));
  EXPECT_FALSE(box.Put(0, TakenAt(0)));
  box.Update(5'000'000'000, MovingEye);
  EXPECT_FALSE(box.images()[0]->camera);
  EXPECT_THAT(box.TakeLost(), IsEmpty());
}

TEST(ImageBox, NamesOnceTheCameraThatHasNoPlace) {
  for (const bool has_calibration : {false, true}) {
    ImageBox box;
    sensor_msgs::CameraInfo message = SomeCalibration();
    message.header.frame_id = "no\x1bwhere";
    if (has_calibration) box.PutCalibration(7, *ToCalibration(message));
    std::vector<WithoutPlace> lost;
    for (int n = 0; n < 40; ++n) {
      EXPECT_FALSE(box.Put(7, TakenAt(n), {1}));
      box.Update(n * 100'000'000LL, MovingEye);
      for (const WithoutPlace& each : box.TakeLost()) {
        EXPECT_GE(n, 10) << "a second";
        lost.push_back(each);
      }
    }
    ASSERT_THAT(lost, SizeIs(1));
    EXPECT_EQ(lost[0].topic, 7u);
    const std::string text = lost[0].Text(TfTree(), "world");
    EXPECT_THAT(text, HasSubstr(has_calibration ? "frame 'no" : "no calibration on camera_info"));
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
