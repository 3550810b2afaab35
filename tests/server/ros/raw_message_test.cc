#include "server/ros/raw_message.h"

#include <gtest/gtest.h>
#include <kinescope/JointLoadArray.h>
#include <kinescope/SetHandLoad.h>
#include <sensor_msgs/JointState.h>

#include <random>

#include "server/ros/link_states.h"
#include "server/ros/names.h"
#include "server/ros/transforms.h"
#include "tests/heap_in_use.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

template <class Message>
std::vector<std::uint8_t> BytesOf(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

const PersonState& Somebody() {
  static const PersonState person =
      testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 1'000'000'000);
  return person;
}

std::vector<std::uint8_t> Transforms() {
  tf2_msgs::TFMessage message;
  FillTransforms(Somebody(), PersonNames("skeleton"), "world", TfShape::kTree, message);
  return BytesOf(message);
}

std::vector<std::uint8_t> LinkStates() {
  xsens_mvn_ros_msgs::LinkStateArray message;
  FillLinkStates(Somebody(), "world", message);
  return BytesOf(message);
}

template <class Message>
void ExpectEveryTruncationRefused(const std::vector<std::uint8_t>& whole) {
  Message message;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(
        Decode({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, message))
        << size << " of " << whole.size() << " bytes";
  }
  ASSERT_TRUE(Decode(whole, message));
  EXPECT_EQ(BytesOf(message), whole);
}

TEST(RawMessage, RestoresTransformsAndLinkStatesAndRejectsEveryTruncation) {
  ExpectEveryTruncationRefused<tf2_msgs::TFMessage>(Transforms());
  ExpectEveryTruncationRefused<xsens_mvn_ros_msgs::LinkStateArray>(LinkStates());
}

visualization_msgs::MarkerArray Markers() {
  visualization_msgs::MarkerArray array;
  array.markers.resize(2);
  for (visualization_msgs::Marker& marker : array.markers) {
    marker.header.frame_id = "world";
    marker.ns = "walls";
    marker.points.resize(3);
    marker.colors.resize(2);
    marker.text = "here";
    marker.mesh_resource = "package://walls/door.stl";
  }
  return array;
}

TEST(RawMessage, RestoresMarkersAndRejectsEveryTruncation) {
  ExpectEveryTruncationRefused<visualization_msgs::MarkerArray>(BytesOf(Markers()));
  ExpectEveryTruncationRefused<visualization_msgs::Marker>(BytesOf(Markers().markers[0]));
}

// Whatever is written over a message: its lists are counted before any of them is reserved, and so
// it is refused or has no more in it than its bytes.
TEST(RawMessage, NeverAllocatesMoreThanItsBytesForDamagedMarkers) {
  const std::vector<std::uint8_t> whole = BytesOf(Markers());
  for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
    for (const std::uint8_t value : {0x7f, 0xff}) {
      std::vector<std::uint8_t> damaged = whole;
      std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(at), 4, value);
      visualization_msgs::MarkerArray message;
      if (!Decode(damaged, message)) continue;
      EXPECT_LE(ros::serialization::serializationLength(message), damaged.size()) << at;
    }
  }
}

// Four thousand million elements would be reserved before the first of them is missed.
TEST(RawMessage, IsRejectedBeforeAllocationIfItsCountsDoNotFit) {
  tf2_msgs::TFMessage transforms;
  auto bytes = Transforms();
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = 0xFF;
  EXPECT_FALSE(Decode(bytes, transforms));
  EXPECT_EQ(transforms.transforms.capacity(), 0U);

  xsens_mvn_ros_msgs::LinkStateArray states;
  bytes = LinkStates();
  const std::size_t count_at = 4 + 8 + 4 + std::string("world").size();
  ASSERT_EQ(bytes[count_at], urdf::kSegmentCount);
  bytes[count_at + 3] = 0x7F;
  EXPECT_FALSE(Decode(bytes, states));
  bytes = LinkStates();
  bytes[15] = 0xFF;  // a frame_id longer than the message
  EXPECT_FALSE(Decode(bytes, states));
  EXPECT_EQ(states.states.capacity(), 0U);
}

// As roscpp decodes a message for a subscriber, and a request for a service.
template <class Message>
bool Receive(std::vector<std::uint8_t> bytes, BoundedMessage<Message>& received) {
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, received);
  return received.is_sound;
}

TEST(BoundedMessage, HasTheTypeOfItsMessage) {
  using Bounded = BoundedMessage<sensor_msgs::JointState>;
  EXPECT_STREQ(ros::message_traits::md5sum<Bounded>(),
               ros::message_traits::md5sum<sensor_msgs::JointState>());
  EXPECT_STREQ(ros::message_traits::datatype<Bounded>(), "sensor_msgs/JointState");
  using Request = kinescope_ros::SetHandLoad::Request;
  EXPECT_STREQ(ros::service_traits::md5sum<BoundedMessage<Request>>(),
               ros::service_traits::md5sum<Request>());
  EXPECT_STREQ(ros::service_traits::datatype<BoundedMessage<Request>>(), "kinescope/SetHandLoad");
}

TEST(BoundedMessage, IsReceivedAsItWasSent) {
  sensor_msgs::JointState sent;
  sent.header.frame_id = "world";
  sent.name = {"jRightKnee_roty", "jLeftKnee_roty"};
  sent.effort = {1.5, -2};
  BoundedMessage<sensor_msgs::JointState> received;
  ASSERT_TRUE(Receive(BytesOf(sent), received));
  EXPECT_EQ(BytesOf(received.message), BytesOf(sent));
}

// roscpp's own deserialisation reserves what the count says, before it misses the first element.
TEST(BoundedMessage, TakesNoMemoryForElementsThatAreNotThere) {
  const std::vector<std::uint8_t> header(16, 0);
  std::vector<std::uint8_t> bytes = header;
  for (const std::uint8_t byte : {0x00, 0x00, 0x00, 0x02})
    bytes.push_back(byte);  // 32 million names
  testing::LargestAllocation();
  BoundedMessage<sensor_msgs::JointState> states;
  EXPECT_FALSE(Receive(bytes, states));
  BoundedMessage<tf2_msgs::TFMessage> transforms;
  EXPECT_FALSE(Receive({0x00, 0x00, 0x00, 0x02}, transforms));
  BoundedMessage<kinescope_ros::JointLoadArray> loads;
  bytes.insert(bytes.begin() + 16, 0);  // its metric
  EXPECT_FALSE(Receive(bytes, loads));
  BoundedMessage<kinescope_ros::SetHandLoad::Request> request;
  bytes.assign(24, 0);
  for (const std::uint8_t byte : {0x00, 0x00, 0x00, 0x02}) bytes.push_back(byte);
  EXPECT_FALSE(Receive(bytes, request));
  EXPECT_LT(testing::LargestAllocation(), 1U << 20U);
}

TEST(RawMessage, IsReadOrRejectedWithRandomBytes) {
  std::mt19937 random(21);
  tf2_msgs::TFMessage transforms;
  xsens_mvn_ros_msgs::LinkStateArray states;
  const auto damage = [&](std::vector<std::uint8_t> bytes) {
    for (int i = 0; i < 8; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    return bytes;
  };
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    refused += !Decode(damage(Transforms()), transforms);
    refused += !Decode(damage(LinkStates()), states);
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace kinescope::ros_bridge
