// Messages that lack something which comes a moment later: at the start, topics come in any order.
#include "server/ros/marker_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <memory>
#include <string>
#include <vector>

namespace kinescope::ros_bridge {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kMillisecond = 1'000'000;

template <class Message>
MarkerDecoder::Event EventOf(const Message& message) {
  const auto raw = boost::make_shared<RawMessage>();
  raw->bytes.resize(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(raw->bytes.data(), static_cast<std::uint32_t>(raw->bytes.size()));
  ros::serialization::serialize(out, message);
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  return MarkerDecoder::Event(raw, header, ros::Time(9, 0));
}

MarkerDecoder::Event EffortOf(double effort) {
  sensor_msgs::JointState state;
  state.name = {"lift"};
  state.effort = {effort};
  return EventOf(state);
}

class LateRobot : public ::testing::Test {
 protected:
  std::optional<ShownJoint> Find(const std::string& name) const {
    if (!is_there_ || name != "lift") return std::nullopt;
    auto joint = std::make_shared<urdf::RobotJoint>();
    joint->name = name;
    joint->type = urdf::RobotJoint::Type::kRevolute;
    joint->axis = {0, 0, 1};
    joint->limits = urdf::JointLimits{-1, 1, 10, 1};
    return ShownJoint{0, joint, "hand"};
  }
  void Hear(double effort, std::int64_t at_ms) {
    decoder_.OnMessage(0, EffortOf(effort), false, at_ms * kMillisecond);
  }
  std::vector<DecodedMessage> Finish(std::int64_t at_ms) {
    decoder_.DecodeKept(at_ms * kMillisecond);
    return decoder_.Take();
  }

  bool is_there_ = false;
  MarkerDecoder decoder_{{ShownTopic{"/joint_states"}},
                         [this](const std::string& name) { return Find(name); }};
};

TEST_F(LateRobot, HasTheRingsOfAMessageThatCameBeforeIt) {
  Hear(5, 100);
  EXPECT_THAT(Finish(150), IsEmpty());
  EXPECT_THAT(Finish(900), IsEmpty());
  is_there_ = true;
  const std::vector<DecodedMessage> decoded = Finish(1000);
  ASSERT_THAT(decoded, SizeIs(1));
  EXPECT_FALSE(decoded[0].refusal);
  EXPECT_THAT(decoded[0].markers, SizeIs(2));
  EXPECT_EQ(decoded[0].monotonic_nanos, 100 * kMillisecond);
  EXPECT_THAT(Finish(2000), IsEmpty());
}

TEST_F(LateRobot, HasTheNewestRingsOnly) {
  Hear(5, 100);
  Hear(6, 200);
  is_there_ = true;
  Hear(7, 300);
  const std::vector<DecodedMessage> decoded = Finish(310);
  ASSERT_THAT(decoded, SizeIs(1));
  EXPECT_EQ(decoded[0].monotonic_nanos, 300 * kMillisecond);
}

TEST_F(LateRobot, ThatDoesNotComeIsNamedAfterASecond) {
  Hear(5, 100);
  EXPECT_THAT(Finish(1050), IsEmpty());
  std::vector<DecodedMessage> decoded = Finish(1100);
  ASSERT_THAT(decoded, SizeIs(1));
  ASSERT_TRUE(decoded[0].refusal);
  EXPECT_STREQ(decoded[0].refusal->kind, "no such joint");
  Hear(6, 1200);
  EXPECT_THAT(decoder_.Take(), SizeIs(1)) << "at once, since then";
  EXPECT_THAT(Finish(1300), IsEmpty());
}

TEST(LateCalibration, IsWaitedFor) {
  sensor_msgs::Image depths;
  depths.width = depths.height = 2;
  depths.encoding = "16UC1";
  depths.step = 4;
  depths.data = {208, 7, 208, 7, 208, 7, 208, 7};  // 2000 mm
  sensor_msgs::CameraInfo info;
  info.width = info.height = 2;
  info.P = {10, 0, 1, 0, 0, 10, 1, 0, 0, 0, 1, 0};
  ShownTopic topic{"/depth/image"};
  topic.style.camera.is_cloud = true;
  MarkerDecoder decoder({topic}, {});
  decoder.OnMessage(0, EventOf(depths), false, 1);
  decoder.DecodeKept(2);
  EXPECT_THAT(decoder.Take(), IsEmpty());
  decoder.OnMessage(0, EventOf(info), false, 3);
  decoder.DecodeKept(4);
  const std::vector<DecodedMessage> decoded = decoder.Take();
  ASSERT_THAT(decoded, SizeIs(1));
  EXPECT_FALSE(decoded[0].refusal);
  ASSERT_THAT(decoded[0].markers, SizeIs(1));
  EXPECT_THAT(decoded[0].markers[0].points, SizeIs(4));
}

}  // namespace
}  // namespace kinescope::ros_bridge
