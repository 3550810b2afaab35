// Several people over a real master: who comes gets topics, frames and a description of their own,
// who leaves is no longer published, and the others notice nothing.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gmock/gmock.h>
#include <kinescope/JointLoadArray.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <urdf/model.h>

#include <map>
#include <thread>

#include "server/mvn/encode.h"
#include "server/mvn/net/sender.h"
#include "server/subject/subject.h"
#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using testing::RosProgram;
using namespace std::chrono_literals;

// Two suits in one network, as MVN streams them.
class Suits {
 public:
  explicit Suits(const std::string& address) : sender_(mvn::OpenSender(address)) {}

  // The next sample of each of `people`; now and then their scale data.
  void Send(const std::vector<int>& people) {
    std::this_thread::sleep_until(next_);  // the pace of a suit, not a wait for something
    next_ += kPeriod;
    ++counter_;
    const double seconds = counter_ / 60.0;
    for (const int person : people) {
      const subject::Motion& motion = *motions_[static_cast<std::size_t>(person)];
      if (counter_ % 30 == 1) {
        Character character = motion.character();
        character.id = person;
        for (const std::string& datagram : mvn::EncodeCharacter(character)) sender_->Send(datagram);
      }
      BodySample sample = motion.At(seconds);
      sample.character = person;
      sample.counter = counter_;
      sample.time_code_millis = static_cast<std::int64_t>(1000 * seconds);
      for (const std::string& datagram : mvn::EncodeSample(sample)) sender_->Send(datagram);
    }
  }

 private:
  static constexpr std::chrono::nanoseconds kPeriod = std::chrono::nanoseconds(1s) / 60;
  std::unique_ptr<mvn::DatagramSender> sender_;
  std::array<std::unique_ptr<subject::Motion>, 2> motions_ = {subject::MakeMotion("walk", 1.6),
                                                              subject::MakeMotion("lift", 1.9)};
  std::uint32_t counter_ = 0;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

class People : public RosProgram {
 protected:
  void SetUp() override {
    RosProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    bridge_ = Start("bridge udp://127.0.0.1:0 --ros required --body_model primitive");
    suits_ = std::make_unique<Suits>(WaitForAddress(*bridge_));
    Hear<sensor_msgs::JointState>("/kinescope/joint_states",
                                  [this](const auto& m) { CountJoints(m, 0); });
    Hear<sensor_msgs::JointState>("/kinescope/skeleton_1/joint_states",
                                  [this](const auto& m) { CountJoints(m, 1); });
    Hear<tf2_msgs::TFMessage>("/tf", [this](const auto& message) {
      for (const auto& one : message.transforms) ++heads_[one.child_frame_id];
    });
  }

  // Sends samples of `people` until `condition` holds.
  template <class Condition>
  bool SendUntil(const std::vector<int>& people, const Condition& condition) {
    const auto deadline = Clock::now() + kPatience;
    while (!condition()) {
      if (Clock::now() > deadline) return false;
      suits_->Send(people);
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0));
    }
    return true;
  }

  void CountJoints(const sensor_msgs::JointState& message, std::size_t person) {
    ++joint_states_[person];
    const std::string name = person == 0 ? "skeleton_c1_head_x" : "skeleton_1_c1_head_x";
    EXPECT_EQ(message.name.at(0), name);
  }

  static double HeightOf(const std::string& parameter) {  // of the shoulders above the hips
    std::string text;
    ::urdf::Model model;
    if (!ros::param::get(parameter, text) || !model.initString(text)) return 0;
    double height = 0;
    for (auto link = model.getLink(
             model.getRoot()->name.substr(0, model.getRoot()->name.size() - 6) + "neck");
         link && link->parent_joint; link = link->getParent()) {
      height += link->parent_joint->parent_to_joint_origin_transform.position.z;
    }
    return height;
  }

  std::unique_ptr<testing::Process> bridge_;
  std::unique_ptr<Suits> suits_;
  std::array<int, 2> joint_states_{};
  std::map<std::string, int> heads_;
};

TEST_F(People, AppearAndLeaveWhileOthersArePublished) {
  const auto both_are_heard = [&, before = joint_states_]() {
    return joint_states_[0] > before[0] + 30 && joint_states_[1] > before[1] + 30 &&
           heads_["skeleton_head"] > 30 && heads_["skeleton_1_head"] > 30;
  };
  ASSERT_TRUE(SendUntil({0, 1}, both_are_heard));

  // Each has the lengths of its own.
  const double ratio = 1.9 / 1.6;
  EXPECT_TRUE(SendUntil({0, 1},
                        [&] {
                          const double first = HeightOf("/robot_description");
                          return first > 0 &&
                                 std::abs(HeightOf("/skeleton_1/robot_description") / first -
                                          ratio) < 1e-4;
                        }))
      << HeightOf("/robot_description") << ", " << HeightOf("/skeleton_1/robot_description");

  // The second leaves. What is under way still comes; then nothing but the first.
  const int at_leaving = joint_states_[0];
  ASSERT_TRUE(SendUntil({0}, [&] { return joint_states_[0] > at_leaving + 15; }));
  const auto before = joint_states_;
  const int head_before = heads_["skeleton_1_head"];
  ASSERT_TRUE(SendUntil({0}, [&] { return joint_states_[0] > before[0] + 120; }))
      << "the first is no longer published";
  EXPECT_EQ(joint_states_[1], before[1]) << "who left is still published";
  EXPECT_EQ(heads_["skeleton_1_head"], head_before);

  // And comes back, under the same names.
  EXPECT_TRUE(SendUntil({0, 1}, [&] { return joint_states_[1] > before[1] + 30; }));
  EXPECT_GT(heads_["skeleton_1_head"], head_before + 30);
}

// Who comes first has the names without a prefix, whatever MVN's number, and the settings are
// theirs; no other's while they are away.
TEST_F(People, SettingsAreOfWhoseTopicsHaveNoPrefix) {
  std::map<std::string, double> masses;
  for (const std::string& name : {std::string(), std::string("skeleton_1/")}) {
    Hear<kinescope_ros::JointLoadArray>(
        "/kinescope/" + name + "joint_loads",
        [&masses, name](const auto& loads) { masses[name] = loads.body_mass; });
  }
  ASSERT_TRUE(SendUntil({1}, [&] { return masses.count("") != 0; }));
  ASSERT_TRUE(SendUntil({0, 1}, [&] { return masses.count("skeleton_1/") != 0; }));
  const auto set_mass = [](double kilograms) {
    dynamic_reconfigure::Reconfigure order;
    order.request.config.doubles.emplace_back();
    order.request.config.doubles.back().name = "mass";
    order.request.config.doubles.back().value = kilograms;
    EXPECT_TRUE(ros::service::call("/kinescope/set_parameters", order));
  };
  const double usual = masses["skeleton_1/"];
  set_mass(101);
  EXPECT_TRUE(SendUntil({0, 1}, [&] { return masses[""] == 101; }));
  EXPECT_EQ(masses["skeleton_1/"], usual);

  const auto since = std::chrono::steady_clock::now();
  ASSERT_TRUE(SendUntil({0}, [&] { return std::chrono::steady_clock::now() - since > 2s; }));
  set_mass(60);
  EXPECT_THAT(WaitForLine(*bridge_, "not set over ROS: "), ::testing::HasSubstr("is away"));
  masses.clear();
  EXPECT_TRUE(SendUntil({0, 1}, [&] { return masses.size() == 2; }));
  EXPECT_EQ(masses[""], 101);
  EXPECT_EQ(masses["skeleton_1/"], usual);
}

}  // namespace
}  // namespace kinescope
