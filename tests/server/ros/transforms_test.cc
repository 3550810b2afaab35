#include "server/ros/transforms.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

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

TEST_F(Transforms, FlatHangsEveryLinkOnTheReferenceFrame) {
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

TEST_F(Transforms, TreePutsEveryLinkWhereFlatDoesThoughSegmentsAreNotRigid) {
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

TEST_F(Transforms, AgreeWithTheUrdfAndTheJointAngles) {
  // What robot_state_publisher would make of them: every joint of the URDF turned by its angle.
  std::map<std::string, double> positions;
  const PersonNames names("skeleton");
  for (std::size_t row = 0; row < JointsByName().size(); ++row) {
    const Eigen::Vector3d& angles = person_.angles[At(JointsByName()[row])];
    for (int axis = 0; axis < 3; ++axis) positions[names.joints[3 * row + At(axis)]] = angles[axis];
  }
  const auto frames = Resolve(Of(person_, TfShape::kFlat), "lab");
  std::map<std::string, Isometry3d> chained;
  chained[model_->robot.root_link] = frames.at(model_->robot.root_link);
  for (const urdf::RobotJoint& joint : model_->robot.joints) {
    chained[joint.child_link] = chained.at(joint.parent_link) * joint.parent_from_joint *
                                Eigen::AngleAxisd(positions.at(joint.name), joint.axis);
  }
  ASSERT_EQ(chained.size(), frames.size());
  for (const auto& [frame, pose] : frames) {
    EXPECT_TRUE(pose.isApprox(chained.at(frame), 1e-9)) << frame;
  }
}

TEST_F(Transforms, TreeHasTheParentsOfTheUrdf) {
  std::map<std::string, std::string> parents;
  for (const auto& one : Of(person_, TfShape::kTree).transforms) {
    parents[one.child_frame_id] = one.header.frame_id;
  }
  EXPECT_EQ(parents.at("skeleton_pelvis"), "lab");
  for (const urdf::RobotJoint& joint : model_->robot.joints) {
    EXPECT_EQ(parents.at(joint.child_link), joint.parent_link);
  }
}

TEST_F(Transforms, FingersHangBelowTheirHandInATreeAndAreWhereFlatHasThem) {
  ExtraSegments& extra = person_.sample.extra;
  for (int i = 0; i < kExtraCount; ++i) {
    if (i >= 2 && i < kMostProps) continue;  // two props
    extra.present.set(At(i));
    extra.poses[At(i)] = {Eigen::Vector3d(0.1, 0.01, 0.02) * i,
                          Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitX()))};
  }
  const auto tree_message = Of(person_, TfShape::kTree);
  const auto flat = Resolve(Of(person_, TfShape::kFlat), "lab");
  const auto tree = Resolve(tree_message, "lab");
  ASSERT_EQ(flat.size(), 67U + 42);
  for (const auto& [frame, pose] : flat) {
    EXPECT_TRUE(tree.at(frame).isApprox(pose, 1e-12)) << frame;
  }
  // A finger is turned as its hand is, so that in the N-pose it is parallel to it.
  const int carpus = FingerIndex(urdf::kLeft, 0);
  const Eigen::Quaterniond turned =
      extra.poses[At(carpus)].orientation * urdf::SegmentFromLink(urdf::kLeftHand);
  EXPECT_TRUE(flat.at("skeleton_left_carpus").linear().isApprox(turned.toRotationMatrix(), 1e-12));
  EXPECT_EQ(flat.at("skeleton_prop2").translation(), extra.poses[1].position);
  std::map<std::string, std::string> parents;
  for (const auto& one : tree_message.transforms) parents[one.child_frame_id] = one.header.frame_id;
  EXPECT_EQ(parents.at("skeleton_left_carpus"), "skeleton_left_hand");
  EXPECT_EQ(parents.at("skeleton_right_second_mc"), "skeleton_right_carpus");
  EXPECT_EQ(parents.at("skeleton_right_second_dp"), "skeleton_right_second_mp");
  EXPECT_EQ(parents.at("skeleton_prop1"), "lab");
}

TEST_F(Transforms, TrackedObjectsAreFramesOfTheirOwn) {
  SceneState scene;
  scene.objects.push_back({7, "HTC Vive 2", {{1, 2, 3}, Eigen::Quaterniond::Identity()}, 5});
  tf2_msgs::TFMessage message;
  AddObjects(scene, PersonNames("skeleton"), "lab", message);
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].child_frame_id, "skeleton_htc_vive_2");
  EXPECT_EQ(message.transforms[0].header.frame_id, "lab");
  EXPECT_EQ(message.transforms[0].transform.translation.z, 3);
}

}  // namespace
}  // namespace kinescope::ros_bridge
