#include "server/ros/force_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "server/ros/joint_states.h"
#include "server/ros/names.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PersonState Person() {
  return testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 2'000'000'003);
}

BodyNow Body() {
  const PersonState person = Person();
  return {person.links, person.model->human.skeleton, 0.0, person.sample.stamp_nanos};
}

geometry_msgs::WrenchStamped Wrench(const Vector3d& force, const Vector3d& moment) {
  geometry_msgs::WrenchStamped message;
  message.wrench.force.x = force.x();
  message.wrench.force.y = force.y();
  message.wrench.force.z = force.z();
  message.wrench.torque.x = moment.x();
  message.wrench.torque.y = moment.y();
  message.wrench.torque.z = moment.z();
  return message;
}

TEST(GroundForce, ActsWhereItsLineMeetsTheFloorInAnyPlateFrame) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Vector3d(number(random), number(random), number(random)); };
  const BodyNow body = Body();
  const Vector3d pelvis = body.links[urdf::kPelvis].position;
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d force(80 * number(random), 80 * number(random), 400 + 300 * number(random));
    const Vector3d cop(pelvis.x() + 0.5 * number(random), pelvis.y() + 0.5 * number(random), 0);
    const double free_moment = 5 * number(random);
    const FoundFrame plate{{vector(), Quaterniond::UnitRandom()}, false};
    const Vector3d moment = (cop - plate.pose.position).cross(force) + Vector3d(0, 0, free_moment);
    const Quaterniond plate_from_world = plate.pose.orientation.conjugate();
    const auto ground =
        ToGroundForce(Wrench(plate_from_world * force, plate_from_world * moment), plate, body);
    ASSERT_TRUE(ground) << ground.error().text;
    EXPECT_LT((ground->force - force).norm(), 1e-9);
    EXPECT_LT((ground->point - cop).norm(), 1e-9);
    EXPECT_NEAR(ground->free_moment, free_moment, 1e-9);
    EXPECT_FALSE(ground->only_vertical);
  }
}

TEST(GroundForce, IsVerticalOnlyForAOneAxisPlate) {
  const BodyNow body = Body();
  const auto ground = ToGroundForce(Wrench({0, 0, 700}, {0, 0, 0}),
                                    {{{0.3, -0.2, 0}, Quaterniond::Identity()}, false}, body);
  ASSERT_TRUE(ground);
  EXPECT_TRUE(ground->only_vertical);
}

TEST(GroundForce, IsZeroBelowTheNoiseLevel) {
  const auto ground = ToGroundForce(Wrench({0, 0, 15}, {8, 8, 0}),
                                    {{{0.3, -0.2, 0}, Quaterniond::Identity()}, false}, Body());
  ASSERT_TRUE(ground);
  EXPECT_EQ(ground->force, Vector3d(Vector3d::Zero()));
}

TEST(GroundForce, IsRejectedWithItsValuesIfImpossible) {
  const FoundFrame frame{{{0.3, -0.2, 0}, Quaterniond::Identity()}, false};
  const struct {
    geometry_msgs::WrenchStamped message;
    const char* kind;
    const char* value;
  } cases[] = {
      {Wrench({0, 0, kNan}, {0, 0, 0}), "not a number", ""},
      {Wrench({0, 0, 700}, {0, std::numeric_limits<double>::infinity(), 0}), "not a number", ""},
      {Wrench({0, 0, 700'000}, {0, 0, 0}), "too large", "7e+05"},
      {Wrench({0, 0, -700}, {0, 0, 0}), "pushes down", "700"},
      {Wrench({0, 0, 700}, {0, 7000, 0}), "far away", "m from the pelvis"},
  };
  for (const auto& [message, kind, value] : cases) {
    const auto ground = ToGroundForce(message, frame, Body());
    ASSERT_FALSE(ground) << kind;
    EXPECT_STREQ(ground.error().kind, kind);
    EXPECT_NE(ground.error().text.find(value), std::string::npos) << ground.error().text;
  }
}

TEST(HandForce, ActsAtTheSensorOrAtTheGrip) {
  const BodyNow body = Body();
  const urdf::Pose& hand = body.links[urdf::kRightHand];
  const Vector3d pull(10, -20, 30);
  const auto own = ToHandForce(Wrench(pull, {}), {hand, true}, urdf::kRight, body);
  ASSERT_TRUE(own);
  EXPECT_LT((own->force - hand.orientation * pull).norm(), 1e-12);
  EXPECT_FALSE(own->point);
  const FoundFrame sensor{{hand.position + Vector3d(0.1, 0, 0), Quaterniond::Identity()}, false};
  const auto measured = ToHandForce(Wrench(pull, {1, 2, 3}), sensor, urdf::kRight, body);
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->point, sensor.pose.position);
  EXPECT_EQ(measured->moment, Vector3d(1, 2, 3));
  const FoundFrame elsewhere{{hand.position + Vector3d(3, 0, 0), Quaterniond::Identity()}, false};
  const auto far = ToHandForce(Wrench(pull, {}), elsewhere, urdf::kRight, body);
  ASSERT_FALSE(far);
  EXPECT_STREQ(far.error().kind, "far away");
}

// What our own joint_states say comes back as the moments that they were made of.
TEST(ExternalEfforts, RestoreTheMomentsUnderOwnJointNames) {
  const PersonState person = Person();
  sensor_msgs::JointState message;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  const auto loads = ToExternalLoads(message, Body(), 1);
  ASSERT_TRUE(loads) << loads.error().text;
  EXPECT_EQ(loads->unknown_joints, 0);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const JointForce& force = person.forces.joints[At(joint)];
    EXPECT_EQ(loads->is_given[At(joint)], force.why_unknown.empty());
    if (!force.why_unknown.empty()) continue;
    EXPECT_LT((loads->joints[At(joint)].moment - force.moment).norm(), 1e-9) << joint;
  }
  const auto reaction = ToExternalLoads(message, Body(), -2);
  EXPECT_LT(
      (reaction->joints[urdf::jL4L3].moment + 2 * person.forces.joints[urdf::jL4L3].moment).norm(),
      1e-9);
}

// Torques about x, then y, then z between T-pose frames, as human-gazebo's models chain them:
// virtual work by differences of orientation, not by our formula.
TEST(ExternalEfforts, UseTheAxesOfHumanGazeboUnderItsJointNames) {
  const BodyNow body = Body();
  const Vector3d moment(7, -11, 5);
  for (const int joint : {urdf::jRightShoulder, urdf::jLeftElbow, urdf::jL5S1, urdf::jRightKnee}) {
    const int parent = urdf::ParentOf(joint), child = urdf::ChildOf(joint);
    const Quaterniond world_from_parent =
        body.links[At(parent)].orientation * urdf::SegmentFromLink(parent).conjugate();
    const Quaterniond world_from_child =
        body.links[At(child)].orientation * urdf::SegmentFromLink(child).conjugate();
    const Eigen::Matrix3d turn =
        (world_from_parent.conjugate() * world_from_child).toRotationMatrix();
    const Vector3d angles(std::atan2(-turn(1, 2), turn(2, 2)), std::asin(turn(0, 2)),
                          std::atan2(-turn(0, 1), turn(0, 0)));
    const auto child_at = [&](const Vector3d& xyz) {
      return Quaterniond(world_from_parent * AngleAxisd(xyz.x(), Vector3d::UnitX()) *
                         AngleAxisd(xyz.y(), Vector3d::UnitY()) *
                         AngleAxisd(xyz.z(), Vector3d::UnitZ()));
    };
    ASSERT_LT(child_at(angles).angularDistance(world_from_child), 1e-9);
    sensor_msgs::JointState message;
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kTinyTurn = 1e-6;
      const AngleAxisd moved(child_at(angles + kTinyTurn * Vector3d::Unit(axis)) *
                             child_at(angles).conjugate());
      message.name.push_back(std::string(urdf::kJoints[At(joint)].mvn_name) + "_rot" +
                             static_cast<char>('x' + axis));
      message.effort.push_back(moment.dot(moved.axis() * moved.angle()) / kTinyTurn);
    }
    const auto loads = ToExternalLoads(message, body, 1);
    ASSERT_TRUE(loads);
    EXPECT_LT((loads->joints[At(joint)].moment - moment).norm(), 1e-3)
        << loads->joints[At(joint)].moment.transpose();
  }
}

TEST(ExternalEfforts, AreRejectedIfEmptyOrOfUnequalLengths) {
  sensor_msgs::JointState message;
  message.name = {"right_elbow_x", "right_elbow_y"};
  message.effort = {1};
  EXPECT_STREQ(ToExternalLoads(message, Body(), 1).error().kind, "unequal lengths");
  message.effort.clear();
  EXPECT_STREQ(ToExternalLoads(message, Body(), 1).error().kind, "no effort");
  message.position = {0.1, 0.2};
  EXPECT_STREQ(ToExternalLoads(message, Body(), 1).error().kind, "no effort")
      << "angles are no ratios";
  message.name.assign(100'000, "right_elbow_x");
  message.position.clear();
  EXPECT_STREQ(ToExternalLoads(message, Body(), 1).error().kind, "too many joints");
}

TEST(ExternalEfforts, CountUnknownJointsAndTreatNaNAsUnknown) {
  sensor_msgs::JointState message;
  message.name = {"wheel_left", "right_elbow_y", "right_knee_y"};
  message.effort = {1, kNan, 20};
  const auto loads = ToExternalLoads(message, Body(), 1);
  ASSERT_TRUE(loads);
  EXPECT_EQ(loads->unknown_joints, 1);
  EXPECT_FALSE(loads->is_given[urdf::jRightElbow]);
  EXPECT_TRUE(loads->is_given[urdf::jRightKnee]);
}

TEST(ExternalRatios, AreAcceptedPerJointWithoutEfforts) {
  sensor_msgs::JointState message;
  message.name = {"right_elbow", "jL5S1", "left_knee"};
  message.position = {0.7, 0.2, -1};
  const auto loads = ToExternalLoads(message, Body(), 1);
  ASSERT_TRUE(loads);
  EXPECT_EQ(loads->joints[urdf::jRightElbow].ratio, 0.7);
  EXPECT_EQ(loads->joints[urdf::jL5S1].ratio, 0.2);
  EXPECT_FALSE(loads->is_given[urdf::jLeftKnee]) << "a negative share is none";
}

TEST(ExternalArray, IsRotatedIntoTheWorldFrameAndKeepsItsClasses) {
  kinescope_ros::JointLoadArray message;
  message.loads.resize(3);
  message.loads[0].joint = "jRightElbow";
  message.loads[0].moment = {1, 0, 0};
  message.loads[0].ratio = kNan;
  message.loads[1].joint = "left_knee";
  message.loads[1].load_class = 77;
  message.loads[1].moment = {kNan, kNan, kNan};
  message.loads[1].ratio = kNan;
  message.loads[2].joint = "jLeftHip";
  message.loads[2].load_class = kinescope_ros::JointLoad::HIGH;
  const FoundFrame turned{{{}, Quaterniond(AngleAxisd(M_PI_2, Vector3d::UnitZ()))}, true};
  const auto loads = ToExternalLoads(message, turned, -1);
  ASSERT_TRUE(loads);
  EXPECT_LT((loads->joints[urdf::jRightElbow].moment - Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_FALSE(loads->is_given[urdf::jLeftKnee]) << "it says nothing";
  EXPECT_EQ(loads->joints[urdf::jLeftHip].load_class, LoadClass::kHigh);
}

tf2_msgs::TFMessage Frame(const std::string& parent, const std::string& child, double x) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms[0];
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.header.stamp = ros::Time(2, 0);
  transform.transform.translation.x = x;
  transform.transform.rotation.w = 1;
  return message;
}

TEST(Frames, AreFoundByEveryLinkNameInTfAndBelowALink) {
  const BodyNow body = Body();
  TfTree tf;
  EXPECT_TRUE(tf.Add(Frame("world", "plate", 1.5), true).empty());
  EXPECT_TRUE(tf.Add(Frame("skeleton_right_hand", "handle", 0.1), true).empty());
  const auto find = [&](const std::string& frame) {
    return FindFrame(frame, 2'000'000'000, "world", "skeleton", body, tf);
  };
  EXPECT_TRUE(find("world")->is_own);
  for (const char* name : {"skeleton_right_hand", "right_hand", "RightHand", "/right_hand"}) {
    ASSERT_TRUE(find(name)) << name;
    EXPECT_EQ(find(name)->pose.position, body.links[urdf::kRightHand].position);
    EXPECT_TRUE(find(name)->is_own);
  }
  ASSERT_TRUE(find("plate"));
  EXPECT_EQ(find("plate")->pose.position.x(), 1.5);
  EXPECT_FALSE(find("plate")->is_own);
  ASSERT_TRUE(find("handle"));
  const urdf::Pose& hand = body.links[urdf::kRightHand];
  EXPECT_LT(
      (find("handle")->pose.position - (hand.position + hand.orientation * Vector3d(0.1, 0, 0)))
          .norm(),
      1e-12);
  EXPECT_FALSE(find("nowhere"));
  EXPECT_FALSE(find(""));
}

// As when a bag is played again: tf2 refuses what is ten seconds older than the newest.
TEST(Frames, AreThoseOfTheNewTimeAfterTimeWasSetBack) {
  TfTree tf;
  tf2_msgs::TFMessage late = Frame("world", "plate", 1);
  late.transforms[0].header.stamp = ros::Time(100, 0);
  EXPECT_TRUE(tf.Add(late, false).empty());
  EXPECT_TRUE(tf.Add(Frame("world", "wall", 4), true).empty());
  const auto x = [&](const std::string& frame) {
    const auto pose = tf.Find("world", frame, 2'000'000'000);
    return pose ? pose->pose.position.x() : kNan;
  };
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(tf.Add(Frame("world", "plate", 2), false).empty());
  EXPECT_EQ(x("plate"), 1) << "a few late transforms are late, and no more";
  EXPECT_TRUE(tf.Add(late, false).empty());
  EXPECT_TRUE(tf.Add(Frame("world", "door", 3), false).empty());
  for (int i = 0; i < 30; ++i) {
    tf2_msgs::TFMessage again = Frame("world", "plate", 5);
    again.transforms[0].header.stamp = ros::Time(2, 1 + i);
    tf.Add(again, false);
  }
  EXPECT_EQ(x("plate"), 5);
  EXPECT_EQ(x("wall"), 4) << "a static frame is sent once";
}

// tf2 takes all of it, and the newest transforms would be those of the last round.
TEST(Frames, AreThoseOfTheNewRoundOfAShortBagInALoop) {
  TfTree tf;
  const auto add = [&](const std::string& child, double x, double secs) {
    tf2_msgs::TFMessage message = Frame("world", child, x);
    message.transforms[0].header.stamp = ros::Time(secs);
    EXPECT_TRUE(tf.Add(message, false).empty());
  };
  const auto newest = [&](const std::string& frame) {
    const auto pose = tf.Find("world", frame, 0);
    return pose ? pose->pose.position.x() : kNan;
  };
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i <= 80; ++i) {  // of 8 s
      const double secs = 100 + 0.1 * i;
      add("odom", secs, secs);
      if (i % 10 == 0) add("slow", secs, secs);
      const bool is_known = round == 0 || i >= 4;
      if (is_known) EXPECT_EQ(newest("odom"), secs) << "round " << round;
      if (is_known && i % 10 == 0) EXPECT_EQ(newest("slow"), secs) << "round " << round;
    }
  }
}

// A simulator that is started again, where a frame is sent once in each run.
TEST(Frames, AreThoseSentSinceTheClockWasSetBack) {
  TfTree tf;
  const auto send = [&](const char* frame, double secs, double x, bool is_static = false) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    geometry_msgs::TransformStamped& transform = message.transforms[0];
    transform.header.frame_id = "world";
    transform.header.stamp = ros::Time(secs);
    transform.child_frame_id = frame;
    transform.transform.translation.x = x;
    transform.transform.rotation.w = 1;
    EXPECT_TRUE(tf.Add(message, is_static).empty()) << frame << " at " << secs;
  };
  const auto x_of = [&](const char* frame) {
    const auto place = tf.Find("world", frame, 0);
    return place ? place->pose.position.x() : -1;
  };
  send("base", 1, 9, true);
  send("box", 2.2, 1);
  send("gone", 5, 1);
  send("early", 0.05, 7);  // of the new run: its clock is heard a little later
  tf.StartAgain(kNanosPerMilli);
  EXPECT_EQ(x_of("box"), -1);
  EXPECT_EQ(tf.frames().count("gone"), 0U);
  EXPECT_EQ(x_of("base"), 9);
  EXPECT_EQ(x_of("early"), 7);
  send("box", 2.1, 2);
  EXPECT_EQ(x_of("box"), 2);
}

TEST(Frames, OfASenderThatIsLateDoNotTakeTheTimeOfAnotherBack) {
  TfTree tf;
  for (int i = 0; i < 60; ++i) {
    const bool is_late = i % 3 != 0;
    tf2_msgs::TFMessage message = Frame("world", "odom", is_late ? 1 : 2);
    message.transforms[0].header.stamp = ros::Time(100 + 0.1 * i - (is_late ? 2 : 0));
    EXPECT_TRUE(tf.Add(message, false).empty());
    EXPECT_EQ(tf.Find("world", "odom", 0).value().pose.position.x(), 2);
  }
}

// One message of the future: tf2 refused all that came then, with two lines each.
TEST(Frames, OfOneThatWasInTheFutureComeBackAndOthersStay) {
  TfTree tf;
  const auto at = [](const std::string& child, double x, int nanos) {
    tf2_msgs::TFMessage message = Frame("world", child, x);
    message.transforms[0].header.stamp = ros::Time(2, static_cast<std::uint32_t>(nanos));
    return message;
  };
  ASSERT_TRUE(tf.Add(at("robot", 7, 0), false).empty());
  tf2_msgs::TFMessage future = Frame("world", "door", 1);
  future.transforms[0].header.stamp = ros::Time(3602, 0);
  ASSERT_TRUE(tf.Add(future, false).empty());
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  int refused = 0;
  for (int i = 1; i <= 30; ++i) {
    refused += tf.Add(at("door", 3, i), false).empty() ? 0 : 1;
    EXPECT_TRUE(tf.Add(at("person", 4, i), false).empty()) << "others go on";
  }
  EXPECT_EQ(refused, 19);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  const auto x = [&](const std::string& frame) {
    const auto pose = tf.Find("world", frame, 2'000'000'000);
    return pose ? pose->pose.position.x() : kNan;
  };
  EXPECT_EQ(x("door"), 3);
  EXPECT_EQ(x("robot"), 7) << "of which one came, once";
  EXPECT_EQ(x("person"), 4);
}

TEST(Frames, AreEarlyUntilATransformOfTheTimeHasCome) {
  TfTree tf;
  tf2_msgs::TFMessage at = Frame("world", "plate", 1);
  at.transforms[0].header.stamp = ros::Time(2);
  ASSERT_TRUE(tf.Add(at, false).empty());
  ASSERT_TRUE(tf.Add(Frame("world", "wall", 4), true).empty());
  const auto find = [&](const char* frame, double secs) {
    return tf.Find("world", frame, static_cast<std::int64_t>(secs * 1e9)).value();
  };
  EXPECT_TRUE(find("plate", 3).is_early);
  EXPECT_EQ(find("plate", 3).pose.position.x(), 1);
  EXPECT_FALSE(find("plate", 1).is_early) << "older than all that is kept";
  EXPECT_FALSE(find("plate", 0).is_early) << "the newest was asked for";
  EXPECT_FALSE(find("wall", 3).is_early) << "it always holds";
  at = Frame("world", "plate", 5);
  at.transforms[0].header.stamp = ros::Time(4);
  ASSERT_TRUE(tf.Add(at, false).empty());
  EXPECT_FALSE(find("plate", 3).is_early);
  EXPECT_EQ(find("plate", 3).pose.position.x(), 3);
}

// A sender whose clock is late, of many frames: none of the others is forgotten.
TEST(Frames, OfOthersStayWhenOneIsLate) {
  TfTree tf;
  tf2_msgs::TFMessage now = Frame("world", "robot", 7), late = Frame("world", "plate", 1);
  now.transforms[0].header.stamp = ros::Time(100, 0);
  ASSERT_TRUE(tf.Add(now, false).empty());
  now.transforms[0].child_frame_id = "plate";
  ASSERT_TRUE(tf.Add(now, false).empty());
  late.transforms.resize(25, late.transforms[0]);
  for (std::uint32_t i = 0; i < 25; ++i) late.transforms[i].header.stamp = ros::Time(40, i);
  tf.Add(late, false);
  const auto robot = tf.Find("world", "robot", 100'000'000'000);
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot->pose.position.x(), 7);
}

// As of a simulator that pauses: tf2 refused each, with a line in the log, and after twenty of them
// all frames were forgotten, as if time had been set back.
TEST(Frames, StayWhenTheNewestTransformComesAgainAndAgain) {
  TfTree tf;
  EXPECT_TRUE(tf.Add(Frame("world", "door", 3), false).empty());
  EXPECT_TRUE(tf.Add(Frame("world", "plate", 1), false).empty());
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(tf.Add(Frame("world", "plate", 1), false).empty());
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(tf.Find("world", "door", 2'000'000'000));
}

TEST(Frames, HaveALimitedNumberOfNames) {
  TfTree tf;
  for (std::size_t i = 0; i < TfTree::kMostFrameNames; ++i) {
    ASSERT_EQ(tf.Add(Frame("world", "f" + std::to_string(i), 1), false).empty(),
              i + 1 < TfTree::kMostFrameNames)
        << i << ", and the world";
  }
  EXPECT_TRUE(tf.Add(Frame("world", "f0", 2), false).empty()) << "those that are known go on";
}

TEST(Frames, AreRejectedIfInvalid) {
  TfTree tf;
  EXPECT_FALSE(tf.Add(Frame("world", "world", 0), false).empty());
  EXPECT_FALSE(tf.Add(Frame("", "plate", 0), false).empty());
  EXPECT_FALSE(tf.Add(Frame("world", std::string(256, 'x'), 0), false).empty());
  tf2_msgs::TFMessage all = Frame("world", "plate", kNan);
  for (const char* child : {"world", "door", "world"}) {
    all.transforms.push_back(Frame("world", child, kNan).transforms[0]);
  }
  all.transforms.push_back(Frame("world", "wall", 2).transforms[0]);
  const std::vector<Refusal> refusals = tf.Add(all, false);
  ASSERT_EQ(refusals.size(), 2U) << "one of each kind";
  EXPECT_EQ(refusals[0].text, "a transform with a number that is not finite: 'plate' in 'world'");
  EXPECT_EQ(refusals[1].text, "a transform whose parent is itself: 'world' in 'world'");
  EXPECT_TRUE(tf.Knows("wall")) << "the others are used";
  EXPECT_EQ(tf.WhySkipped("door"), "with a number that is not finite");
  EXPECT_EQ(tf.WhySkipped("wall"), "");
  tf2_msgs::TFMessage no_turn = Frame("world", "plate", 0);
  no_turn.transforms[0].transform.rotation.w = 0;
  EXPECT_FALSE(tf.Add(no_turn, false).empty());
  EXPECT_FALSE(tf.Find("world", "plate", 2'000'000'000));
}

}  // namespace
}  // namespace kinescope::ros_bridge
