#include "server/ros/scene_frame.h"

#include <gtest/gtest.h>

#include "tests/captured_log.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

tf2_msgs::TFMessage Below(const std::string& parent, const std::string& child) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].header.stamp = ros::Time(100);
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.rotation.w = 1;
  return message;
}

TEST(SceneFrame, IsTheWantedOneWhereItIsKnown) {
  const auto tf = std::make_shared<TfTree>();
  SceneFrame frame("world", tf);
  tf->Add(Below("map", "odom"), false);
  tf->Add(Below("world", "camera"), false);
  frame.Update(kSecond, "odom");
  EXPECT_EQ(frame.name(), "world");
}

TEST(SceneFrame, IsTheRootOfTfWithoutPeople) {
  const testing::CapturedLog log;
  const auto tf = std::make_shared<TfTree>();
  SceneFrame frame("world", tf);
  frame.Update(kSecond, "");
  EXPECT_EQ(frame.name(), "world");
  tf->Add(Below("odom", "base_link"), false);
  frame.Update(2 * kSecond, "");
  EXPECT_EQ(frame.name(), "odom");
  tf->Add(Below("map", "odom"), false);
  EXPECT_FALSE(frame.IsDue(2 * kSecond + 1)) << "it looks twice a second";
  EXPECT_TRUE(frame.IsDue(3 * kSecond));
  frame.Update(3 * kSecond, "");
  EXPECT_EQ(frame.name(), "map");
  EXPECT_NE(log.text().find("stands in the frame 'map': TF has none called 'world'"),
            std::string::npos)
      << log.text();
  frame.SetPerson();
  EXPECT_TRUE(frame.IsDue(3 * kSecond + 1));
  frame.Update(3 * kSecond + 1, "");
  EXPECT_EQ(frame.name(), "world") << "that of people";
  EXPECT_FALSE(frame.IsDue(9 * kSecond));
}

TEST(SceneFrame, IsThatOfAMarkerWithoutTf) {
  SceneFrame frame("world", std::make_shared<TfTree>());
  frame.Update(kSecond, "map");
  EXPECT_EQ(frame.name(), "world") << "its frames may come after it";
  for (int second = 2; second < 6; ++second) frame.Update(second * kSecond, "map");
  EXPECT_EQ(frame.name(), "map");
  frame.Update(6 * kSecond, "");
  EXPECT_EQ(frame.name(), "map") << "the marker is gone";
}

}  // namespace
}  // namespace kinescope::ros_bridge
