#include "server/ros/suit_messages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "server/ros/stamp.h"
#include "tests/server/ros/test_person.h"
#include "urdf/landmarks.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::int64_t kNoon = 1'700'049'600'000'000'000;  // 2023-11-15 12:00:00 UTC

class SuitMessages : public ::testing::Test {
 protected:
  SuitMessages() {
    TrackerState& tracker = person_.sample.trackers[urdf::kL3];
    tracker.orientation = Quaterniond(0.5, 0.5, -0.5, 0.5);
    tracker.acceleration = {1, 2, 9.8};
    tracker.angular_velocity = {0.1, 0.2, 0.3};
    tracker.magnetic_field = {0.6, 0, -0.8};
    tracker.has_rates = true;
    person_.sample.has_tracker.set(urdf::kL3);
  }

  PersonState person_ =
      testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, kNoon + 250'000'000);
  const PersonNames names_{"skeleton"};
};

TEST_F(SuitMessages, HaveWhatASensorMeasuresInItsOwnAxes) {
  sensor_msgs::Imu imu;
  FillImu(person_, names_, urdf::kL3, imu);
  EXPECT_EQ(imu.header.frame_id, "skeleton_l3_imu");
  EXPECT_EQ(imu.header.stamp, ros::Time(1'700'049'600, 250'000'000));
  EXPECT_EQ(imu.orientation.y, -0.5);
  EXPECT_EQ(imu.linear_acceleration.z, 9.8) << "with gravity, as accelerometers measure";
  EXPECT_EQ(imu.angular_velocity.y, 0.2);
  EXPECT_EQ(imu.angular_velocity_covariance[0], 0) << "unknown, but measured";
  sensor_msgs::MagneticField field;
  FillMagneticField(person_, names_, urdf::kL3, field);
  EXPECT_EQ(field.header, imu.header);
  EXPECT_EQ(field.magnetic_field.z, -0.8);
}

TEST_F(SuitMessages, SayThatRatesAreNotMeasuredWhereTheSuitOmitsThem) {
  person_.sample.trackers[urdf::kL3].has_rates = false;
  sensor_msgs::Imu imu;
  FillImu(person_, names_, urdf::kL3, imu);
  EXPECT_EQ(imu.angular_velocity_covariance[0], -1);
  EXPECT_EQ(imu.linear_acceleration_covariance[0], -1);
  EXPECT_EQ(imu.orientation_covariance[0], 0);
}

TEST_F(SuitMessages, HaveAFrameForEachSensorThatIsAskedFor) {
  tf2_msgs::TFMessage message;
  AddSensors(person_, names_, person_.sample.has_tracker, "world", message);
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].child_frame_id, "skeleton_l3_imu");
  EXPECT_EQ(message.transforms[0].header.frame_id, "world");
  EXPECT_EQ(message.transforms[0].transform.rotation.y, -0.5);
  EXPECT_EQ(message.transforms[0].transform.translation.z, person_.links[urdf::kL3].position.z());
}

TEST_F(SuitMessages, HaveLandmarksWhereTheLinksAre) {
  const urdf::Landmarks landmarks = LandmarksToPublish(*person_.model);
  ASSERT_FALSE(landmarks.empty()) << "the skeleton's, where none came";
  kinescope_ros::LandmarkArray message;
  FillLandmarks(person_, names_, landmarks, "world", message);
  ASSERT_EQ(message.landmarks.size(), landmarks.size());
  int joints = 0;
  for (const kinescope_ros::Landmark& landmark : message.landmarks) {
    const auto link = std::find(names_.links.begin(), names_.links.end(), landmark.link);
    ASSERT_NE(link, names_.links.end()) << landmark.link;
    const urdf::Pose& pose = person_.links[static_cast<std::size_t>(link - names_.links.begin())];
    const Vector3d in_link(landmark.in_link.x, landmark.in_link.y, landmark.in_link.z);
    const Vector3d position(landmark.position.x, landmark.position.y, landmark.position.z);
    EXPECT_TRUE(position.isApprox(pose.position + pose.orientation * in_link, 1e-9))
        << landmark.name;
    if (landmark.name != "jRightElbow") continue;
    ++joints;
    EXPECT_TRUE(position.isApprox(person_.links[urdf::kRightForeArm].position, 1e-9));
  }
  EXPECT_EQ(joints, 2) << "on the upper arm and on the forearm";
}

TEST_F(SuitMessages, HaveTheClocksOfTheSuit) {
  person_.sample.time_code_millis = 81'500;
  sensor_msgs::TimeReference message;
  FillTimeCode(person_.sample, message);
  EXPECT_EQ(message.time_ref, ros::Time(81, 500'000'000));
  EXPECT_EQ(message.source, "mvn_time_code");
  person_.sample.utc_millis_of_day = 12 * 3'600'000 + 100;
  FillUtc(person_.sample, message);
  EXPECT_EQ(message.time_ref, ros::Time(1'700'049'600, 100'000'000));
  EXPECT_EQ(message.header.stamp, ros::Time(1'700'049'600, 250'000'000));
}

TEST_F(SuitMessages, HaveTheDateOfTheNearestMidnight) {
  sensor_msgs::TimeReference message;
  const std::int64_t midnight = kNoon - 12LL * 3600 * 1'000'000'000;
  person_.sample.stamp_nanos = midnight + 5'000'000'000;  // the suit's clock is 10 s behind
  person_.sample.utc_millis_of_day = 24 * 3'600'000 - 5'000;
  FillUtc(person_.sample, message);
  EXPECT_EQ(ToNanos(message.time_ref), midnight - 5'000'000'000);
}

}  // namespace
}  // namespace kinescope::ros_bridge
