#include "server/ros/transforms.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "server/ros/joint_states.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Isometry3d;

Isometry3d AsIsometry(const geometry_msgs::Transform& transform) {
  Isometry3d result = Isometry3d::Identity();
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  result.translate(Eigen::Vector3d(t.x, t.y, t.z));
  result.rotate(Eigen::Quaterniond(r.w, r.x, r.y, r.z));
  return result;
}

// reference_from_frame of every frame in the message, by walking up from each.
std::map<std::string, Isometry3d> Resolve(const tf2_msgs::TFMessage& message,
                                          const std::string& reference) {
  std::map<std::string, std::pair<std::string, Isometry3d>> up;
  for (const auto& one : message.transforms) {
    const bool is_new =
        up.emplace(one.child_frame_id, std::pair(one.header.frame_id, AsIsometry(one.transform)))
            .second;
    EXPECT_TRUE(is_new) << one.child_frame_id << " has two parents";
  }
  std::map<std::string, Isometry3d> resolved;
  for (const auto& [frame, edge] : up) {
    Isometry3d pose = edge.second;
    std::string parent = edge.first;
    for (int steps = 0; parent != reference; ++steps) {
      if (up.count(parent) == 0 || steps > 100) {
        ADD_FAILURE() << frame << " does not lead to " << reference;
        break;
      }
      pose = up.at(parent).second * pose;
      parent = up.at(parent).first;
    }
    resolved[frame] = pose;
  }
  return resolved;
}

class Transforms : public ::testing::Test {
 protected:
  static tf2_msgs::TFMessage Of(const PersonState& person, TfShape shape) {
    tf2_msgs::TFMessage message;
    FillTransforms(person, PersonNames("skeleton"), "lab", shape, message);
    return message;
  }

  const std::shared_ptr<const PersonModel> model_ = testing::MakeModel();
  PersonState person_ = testing::MakePerson(model_, testing::Posture(2), 5, 1'234'567'890);
};

TEST_F(Transforms, OfTheLinksInsideTheJointsAreTheSameAlone) {
  const auto all = Resolve(Of(person_, TfShape::kFlat), "lab");
  tf2_msgs::TFMessage message;
  FillInnerTransforms(person_, PersonNames("skeleton"), "lab", message);
  ASSERT_EQ(message.transforms.size(), 44U);
  for (const auto& [frame, pose] : Resolve(message, "lab")) {
    EXPECT_TRUE(pose.isApprox(all.at(frame), 1e-12)) << frame;
    EXPECT_NE(frame.find("_link"), std::string::npos) << frame;
  }
}

TEST_F(Transforms, HaveTheReferenceFrameAsParentInFlatMode) {
  const auto message = Of(person_, TfShape::kFlat);
  ASSERT_EQ(message.transforms.size(), 67U);
  for (const auto& one : message.transforms) {
    EXPECT_EQ(one.header.frame_id, "lab");
    EXPECT_EQ(one.header.stamp, ros::Time(1, 234'567'890));
  }
  const auto frames = Resolve(message, "lab");
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const urdf::Pose& link = person_.links[At(segment)];
    const Isometry3d& pose = frames.at(urdf::LinkName("skeleton", segment));
    EXPECT_EQ(pose.translation(), link.position);
    EXPECT_TRUE(pose.linear().isApprox(link.orientation.toRotationMatrix(), 1e-12));
  }
}

TEST_F(Transforms, HaveThePelvisAloneForRobotStatePublisher) {
  const auto message = Of(person_, TfShape::kBase);
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].header.frame_id, "lab");
  EXPECT_EQ(message.transforms[0].child_frame_id, "skeleton_pelvis");
}

TEST_F(Transforms, PutEveryLinkAtTheSamePlaceInTreeAndFlatMode) {
  for (std::size_t i = 0; i < person_.links.size(); ++i) {
    person_.links[i].position += Eigen::Vector3d(0.003, -0.002, 0.001) * static_cast<double>(i);
  }
  const auto flat = Resolve(Of(person_, TfShape::kFlat), "lab");
  const auto tree = Resolve(Of(person_, TfShape::kTree), "lab");
  ASSERT_EQ(flat.size(), 67U);
  ASSERT_EQ(tree.size(), 67U);
  for (const auto& [frame, pose] : flat) {
    EXPECT_TRUE(tree.at(frame).isApprox(pose, 1e-12)) << frame;
  }
}

// What robot_state_publisher would make of a URDF and joint states: every joint moved by its
// position. The root is where `frames` has it.
std::map<std::string, Isometry3d> Chain(const PersonState& person, const PersonNames& names,
                                        const std::map<std::string, Isometry3d>& frames) {
  sensor_msgs::JointState message;
  FillComputedJointStates(person, names, message);
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    positions[message.name[i]] = message.position[i];
  }
  const urdf::RobotModel robot = urdf::ParseUrdf(person.model->urdf_xml);
  EXPECT_EQ(positions.size(), robot.joints.size());
  std::map<std::string, Isometry3d> chained;
  chained[robot.root_link] = frames.at(robot.root_link);
  for (const urdf::RobotJoint& joint : robot.joints) {
    const double position = positions.at(joint.name);
    Isometry3d motion = Isometry3d::Identity();
    if (joint.type == urdf::RobotJoint::Type::kPrismatic) {
      motion.translation() = position * joint.axis;
    } else {
      motion.linear() = Eigen::AngleAxisd(position, joint.axis).toRotationMatrix();
    }
    chained[joint.child_link] = chained.at(joint.parent_link) * joint.parent_from_joint * motion;
  }
  return chained;
}

TEST_F(Transforms, AgreeWithTheUrdfAndTheJointAngles) {
  const auto frames = Resolve(Of(person_, TfShape::kFlat), "lab");
  const auto chained = Chain(person_, PersonNames("skeleton"), frames);
  ASSERT_EQ(chained.size(), frames.size());
  for (const auto& [frame, pose] : frames) {
    EXPECT_TRUE(pose.isApprox(chained.at(frame), 1e-9)) << frame;
  }
}

TEST_F(Transforms, HaveTheParentsOfTheUrdfInTreeMode) {
  std::map<std::string, std::string> parents;
  for (const auto& one : Of(person_, TfShape::kTree).transforms) {
    parents[one.child_frame_id] = one.header.frame_id;
  }
  EXPECT_EQ(parents.at("skeleton_pelvis"), "lab");
  for (const urdf::RobotJoint& joint : model_->robot.joints) {
    EXPECT_EQ(parents.at(joint.child_link), joint.parent_link);
  }
}

class GlovedTransforms : public Transforms {
 protected:
  GlovedTransforms() { testing::BendFingers(0.4, person_); }

  static tf2_msgs::TFMessage Of(const PersonState& person, TfShape shape) {
    tf2_msgs::TFMessage message;
    FillTransforms(person, PersonNames(person.model->human), "lab", shape, message);
    return message;
  }

  const std::shared_ptr<const PersonModel> gloved_ = testing::MakeGlovedModel();
  PersonState person_ = testing::MakePerson(gloved_, testing::Posture(2), 5, 1'234'567'890);
};

TEST_F(GlovedTransforms, AgreeWithTheUrdfAndTheJointAngles) {
  for (const TfShape shape : {TfShape::kFlat, TfShape::kTree}) {
    const auto frames = Resolve(Of(person_, shape), "lab");
    ASSERT_EQ(frames.size(), 67U + 120 + 12);
    const auto chained = Chain(person_, PersonNames(gloved_->human), frames);
    ASSERT_EQ(chained.size(), frames.size());
    for (const auto& [frame, pose] : frames) {
      EXPECT_TRUE(pose.isApprox(chained.at(frame), 1e-9)) << frame;
    }
  }
}

TEST_F(GlovedTransforms, PutFingersAndPropsAtTheSamePlaceInTreeAndFlatMode) {
  for (auto& glove : person_.gloves) {
    for (std::size_t i = 0; i < glove->links.size(); ++i) {
      glove->links[i].position += Eigen::Vector3d(0.003, -0.002, 0.001) * static_cast<double>(i);
    }
  }
  const auto flat = Resolve(Of(person_, TfShape::kFlat), "lab");
  const auto tree = Resolve(Of(person_, TfShape::kTree), "lab");
  for (const auto& [frame, pose] : flat) {
    EXPECT_TRUE(tree.at(frame).isApprox(pose, 1e-12)) << frame;
  }
  const urdf::Pose& tip = person_.gloves[urdf::kLeft]->links[7];
  EXPECT_EQ(flat.at("skeleton_left_second_dp").translation(), tip.position);
  EXPECT_EQ(flat.at("skeleton_prop2").translation(), person_.props[1]->pose.position);
}

TEST_F(GlovedTransforms, HaveTheParentsOfTheUrdfInTreeMode) {
  std::map<std::string, std::string> parents;
  for (const auto& one : Of(person_, TfShape::kTree).transforms) {
    parents[one.child_frame_id] = one.header.frame_id;
  }
  for (const urdf::RobotJoint& joint : urdf::ParseUrdf(gloved_->urdf_xml).joints) {
    EXPECT_EQ(parents.at(joint.child_link), joint.parent_link);
  }
  EXPECT_EQ(parents.at("skeleton_left_carpus_y_link"), "skeleton_left_hand");
  EXPECT_EQ(parents.at("skeleton_right_second_mc_y_link"), "skeleton_right_carpus");
  EXPECT_EQ(parents.at("skeleton_prop1_tx_link"), "skeleton_pelvis");
}

TEST_F(Transforms, IncludeTrackedObjects) {
  SceneState scene;
  scene.objects.push_back({7, 1, "HTC Vive 2", {{1, 2, 3}, Eigen::Quaterniond::Identity()}, 5});
  tf2_msgs::TFMessage message;
  AddObjects(scene, PersonNames("skeleton"), "lab", message);
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].child_frame_id, "skeleton_htc_vive_2");
  EXPECT_EQ(message.transforms[0].header.frame_id, "lab");
  EXPECT_EQ(message.transforms[0].transform.translation.z, 3);
}

}  // namespace
}  // namespace kinescope::ros_bridge
