// What the suit itself measures and knows, over ROS: sensors, landmarks, clocks; a real master, a
// suit over UDP, `kinescope bridge`.
#include <gtest/gtest.h>
#include <kinescope/LandmarkArray.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/TimeReference.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

class SuitOverRos : public testing::RosProgram {
 protected:
  // Names that begin with `prefix` of what the bridge has registered.
  static std::set<std::string> TopicsBelow(const std::string& prefix) {
    std::set<std::string> names;
    ros::master::V_TopicInfo topics;
    ros::master::getTopics(topics);
    for (const auto& topic : topics) {
      if (topic.name.rfind(prefix, 0) == 0) names.insert(topic.name);
    }
    return names;
  }

  void StartBridge(const std::string& types) {
    bridge_ = Start("bridge udp://127.0.0.1:0 --ros required");
    suit_ = Start("stream demo:walk --types " + types + " --to " + WaitForAddress(*bridge_));
  }

  std::unique_ptr<testing::Process> bridge_, suit_;
};

TEST_F(SuitOverRos, SensorsHaveTopicsAndFramesWhereTheSuitSendsThem) {
  StartBridge("02,12,13,23,25");
  ASSERT_TRUE(Spin([] { return TopicsBelow("/kinescope/magnetic_field/").size() == 17; }));
  EXPECT_EQ(TopicsBelow("/kinescope/imu/").size(), 17U);
  std::set<std::string> frames;
  Hear<tf2_msgs::TFMessage>("/tf", [&](const auto& message) {
    for (const auto& one : message.transforms) frames.insert(one.child_frame_id);
  });
  ASSERT_TRUE(Spin([&] { return frames.count("skeleton_pelvis") != 0; }));
  EXPECT_EQ(frames.count("skeleton_pelvis_imu"), 0U) << "nobody listens to the sensor";
  std::optional<sensor_msgs::Imu> imu;
  std::optional<sensor_msgs::MagneticField> field;
  Hear<sensor_msgs::Imu>("/kinescope/imu/pelvis", [&](const auto& message) { imu = message; });
  Hear<sensor_msgs::MagneticField>("/kinescope/magnetic_field/pelvis",
                                   [&](const auto& message) { field = message; });
  ASSERT_TRUE(Spin([&] { return imu && field && frames.count(imu->header.frame_id) != 0; }));
  EXPECT_EQ(imu->header.frame_id, "skeleton_pelvis_imu");
  EXPECT_EQ(frames.count("skeleton_right_hand_imu"), 0U) << "nobody listens to this one";
  const auto& a = imu->linear_acceleration;
  EXPECT_NEAR(std::hypot(a.x, a.y, a.z), 9.8, 5) << "with gravity";
  const auto& m = field->magnetic_field;
  EXPECT_NEAR(std::hypot(m.x, m.y, m.z), 1, 0.3);

  std::optional<sensor_msgs::TimeReference> time_code, utc;
  Hear<sensor_msgs::TimeReference>("/kinescope/time_code",
                                   [&](const auto& message) { time_code = message; });
  Hear<sensor_msgs::TimeReference>("/kinescope/utc", [&](const auto& message) { utc = message; });
  ASSERT_TRUE(Spin([&] { return time_code && utc; }));
  EXPECT_LT(time_code->time_ref, ros::Time(3600)) << "since the recording began";
  EXPECT_NEAR((utc->time_ref - utc->header.stamp).toSec(), 0, 5);

  std::optional<kinescope_ros::LandmarkArray> landmarks;
  Hear<kinescope_ros::LandmarkArray>("/kinescope/landmarks",
                                     [&](const auto& message) { landmarks = message; });
  ASSERT_TRUE(Spin([&] { return landmarks.has_value(); }));
  EXPECT_TRUE(std::any_of(landmarks->landmarks.begin(), landmarks->landmarks.end(),
                          [](const auto& landmark) { return landmark.name == "pTopOfHead"; }));
}

TEST_F(SuitOverRos, HasNoTopicsOfSensorsThatItDoesNotSend) {
  StartBridge("02,12,13");
  std::optional<sensor_msgs::TimeReference> time_code;
  Hear<sensor_msgs::TimeReference>("/kinescope/time_code",
                                   [&](const auto& message) { time_code = message; });
  ASSERT_TRUE(Spin([&] { return time_code.has_value(); }));
  EXPECT_TRUE(TopicsBelow("/kinescope/imu/").empty());
}

}  // namespace
}  // namespace kinescope
