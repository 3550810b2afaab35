// A monitor on another computer has the loads of the node beside the suit, with what that one was
// told. Everything is real.
#include <gtest/gtest.h>
#include <kinescope/JointLoadArray.h>
#include <kinescope/PersonArray.h>
#include <kinescope/SetHandLoad.h>

#include <cmath>
#include <optional>
#include <string>

#include "tests/system/ros/ros_fixture.h"
#include "urdf/segments.h"

namespace kinescope {
namespace {

class ToldPeople : public testing::RosProgram {
 protected:
  using Loads = std::optional<kinescope_ros::JointLoadArray>;

  void SetUp() override {
    RosProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    Hear<kinescope_ros::JointLoadArray>("/bridge_a/joint_loads",
                                        [this](const auto& m) { of_bridge_ = m; });
    Hear<kinescope_ros::JointLoadArray>("/monitor/joint_loads",
                                        [this](const auto& m) { of_monitor_ = m; });
  }

  static bool AreHeld(const Loads& loads, double right_kg, double left_kg) {
    return loads && std::abs(loads->held_mass[urdf::kRight] - right_kg) < 1e-9 &&
           std::abs(loads->held_mass[urdf::kLeft] - left_kg) < 1e-9;
  }
  static double MomentOf(const Loads& loads, const std::string& joint) {
    for (const kinescope_ros::JointLoad& load : loads->loads) {
      if (load.joint != joint) continue;
      return std::hypot(load.moment[0], load.moment[1], load.moment[2]);
    }
    throw std::out_of_range(joint);
  }

  Loads of_bridge_, of_monitor_;
};

TEST_F(ToldPeople, HaveTheSameLoadsOnAMonitor) {
  const auto monitor = Start("bridge ros: --ros required __name:=monitor");
  const auto bridge = Start(
      "bridge demo:t_pose --ros required --sex female --mass 70 --hand_load right:2 "
      "__name:=bridge_a");
  ASSERT_TRUE(Spin([&] { return AreHeld(of_bridge_, 2, 0) && AreHeld(of_monitor_, 2, 0); }));
  EXPECT_NEAR(of_monitor_->body_mass, 70, 1e-9);
  EXPECT_FALSE(of_monitor_->body_mass_assumed);
  EXPECT_NEAR(of_monitor_->loads.at(0).capacity, of_bridge_->loads.at(0).capacity, 1e-6);
  for (const char* const joint : {"jRightShoulder", "jLeftShoulder"}) {
    const double moment = MomentOf(of_bridge_, joint);
    EXPECT_NEAR(MomentOf(of_monitor_, joint), moment, 0.01 * moment) << joint;
  }

  ros::ServiceClient held =
      node_->serviceClient<kinescope_ros::SetHandLoad>("/bridge_a/set_hand_load");
  kinescope_ros::SetHandLoad order;
  order.request.both_kg = 10;
  ASSERT_TRUE(held.call(order) && order.response.success) << order.response.message;
  EXPECT_TRUE(Spin([&] { return AreHeld(of_bridge_, 5, 5) && AreHeld(of_monitor_, 5, 5); }));
}

TEST_F(ToldPeople, AreAsTheMonitorsOwnOptionsSayIfItHasSome) {
  std::optional<kinescope_ros::PersonArray> people;
  Hear<kinescope_ros::PersonArray>("/kinescope/people", [&](const auto& m) { people = m; });
  const auto bridge =
      Start("bridge demo:t_pose --ros required --mass 70 --hand_load right:2 __name:=bridge_a");
  const auto monitor =
      Start("bridge ros: --ros required --mass 80 --hand_load none __name:=monitor");
  ASSERT_TRUE(Spin([&] { return AreHeld(of_bridge_, 2, 0) && of_monitor_ && people; }));
  EXPECT_TRUE(AreHeld(of_monitor_, 0, 0));
  EXPECT_NEAR(of_monitor_->body_mass, 80, 1e-9);
  ASSERT_EQ(people->people.size(), 1U);
  EXPECT_EQ(people->people[0].pelvis_frame, "skeleton_pelvis");
  EXPECT_EQ(people->people[0].topics, "/bridge_a/");
  EXPECT_EQ(people->people[0].body_mass, 70) << "the monitor is not asked";
}

}  // namespace
}  // namespace kinescope
