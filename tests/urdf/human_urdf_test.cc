#include "urdf/human_urdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "urdf/hand_surface.h"
#include "urdf/joint_limits.h"
#include "urdf/kinematics.h"
#include "urdf/primitive_body.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::urdf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

HumanModel Human(const std::string& name = "skeleton") {
  HumanModel human;
  human.model_name = name;
  human.skeleton = DefaultSkeleton();
  human.body = MakeBodyParameters({}, human.skeleton);
  return human;
}

TEST(HumanUrdf, Has23LinksWithMassAnd66RevoluteJoints) {
  const RobotModel robot = ParseUrdf(WriteUrdf(Human()));
  EXPECT_EQ(robot.root_link, "skeleton_pelvis");
  int with_mass = 0;
  double mass = 0;
  for (const Link& link : robot.links) {
    mass += link.mass;
    with_mass += link.mass > 0;
    EXPECT_EQ(link.mass > 0, !link.visuals.empty()) << link.name;
  }
  EXPECT_EQ(with_mass, kSegmentCount);
  EXPECT_NEAR(mass, 75.0, 1e-9);
  EXPECT_EQ(robot.links.size(), std::size_t{kSegmentCount + 2 * kJointCount});
  ASSERT_EQ(robot.joints.size(), std::size_t{3} * kJointCount);
  for (const RobotJoint& joint : robot.joints) {
    EXPECT_EQ(joint.type, RobotJoint::Type::kRevolute) << joint.name;
  }
}

// Chains the URDF itself, joint by joint, by the names of its joints.
std::map<std::string, Isometry3d> Chain(const RobotModel& robot, const Isometry3d& root,
                                        const std::map<std::string, double>& positions) {
  std::map<std::string, Isometry3d> world_from_link = {{robot.root_link, root}};
  for (const RobotJoint& joint : robot.joints) {
    world_from_link[joint.child_link] =
        world_from_link.at(joint.parent_link) * joint.parent_from_joint *
        Isometry3d(Eigen::AngleAxisd(positions.at(joint.name), joint.axis.normalized()));
  }
  return world_from_link;
}

TEST(HumanUrdf, MovesAsComputedByTheKinematics) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-1.2, 1.2);
  const HumanModel human = Human();
  const RobotModel robot = ParseUrdf(WriteUrdf(human));
  for (int trial = 0; trial < 40; ++trial) {
    JointAngles angles;
    std::map<std::string, double> positions;
    for (int joint = 0; joint < kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        angles[static_cast<std::size_t>(joint)][axis] =
            positions[JointName("skeleton", joint, axis)] = angle(random);
      }
    }
    const Pose pelvis = {{1, -2, 0.97}, RotationFromAngles({0.1, 0.4, -2})};
    const LinkPoses links = ForwardKinematics(human.skeleton, pelvis, angles);
    Isometry3d root = Isometry3d::Identity();
    root.linear() = pelvis.orientation.toRotationMatrix();
    root.translation() = pelvis.position;
    const auto chained = Chain(robot, root, positions);
    for (int i = 0; i < kSegmentCount; ++i) {
      const Isometry3d& link = chained.at(LinkName("skeleton", i));
      const Pose& ours = links[static_cast<std::size_t>(i)];
      EXPECT_LT((link.translation() - ours.position).norm(), 1e-9)
          << kSegments[static_cast<std::size_t>(i)].link_name;
      EXPECT_LT((link.linear() - ours.orientation.toRotationMatrix()).norm(), 1e-9);
    }
  }
}

TEST(HumanUrdf, KeepsUnsafeNamesOutOfTheDocument) {
  const RobotModel robot = ParseUrdf(WriteUrdf(Human("a<b>\"&/ c")));
  EXPECT_EQ(robot.root_link, "a_b_____c_pelvis");
}

TEST(HumanUrdf, NamesItsMeshesIfAFolderIsGiven) {
  HumanModel human = Human();
  human.mesh_folder = "/some/folder";
  for (const Link& link : ParseUrdf(WriteUrdf(human)).links) {
    if (link.mass == 0) continue;
    ASSERT_EQ(link.visuals.size(), 1u);
    EXPECT_EQ(link.visuals[0].geometry.kind, Geometry::Kind::kMesh);
    EXPECT_EQ(link.visuals[0].geometry.mesh_uri,
              "file:///some/folder/" + link.name.substr(std::string("skeleton_").size()) + ".stl");
  }
}

// Bodies of every build: what a suit can measure, with a size for each part.
HumanModel RandomHuman(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  const auto between = [&](double low, double high) { return low + (high - low) * share(random); };
  HumanModel human;
  human.skeleton = DefaultSkeleton(between(1.0, 2.2));
  for (Vector3d& offset : human.skeleton.origin_in_parent) {
    offset = offset.cwiseProduct(Vector3d(between(0.8, 1.2), between(0.8, 1.2), between(0.8, 1.2)));
  }
  BodyDescription body;
  body.sex = share(random) < 0.5 ? Sex::kMale : Sex::kFemale;
  body.mass_kg = between(20, 300);
  human.body = MakeBodyParameters(body, human.skeleton);
  if (share(random) < 0.5) {
    for (const Side side : {kRight, kLeft}) {
      const double length = human.skeleton.finger_tip_in_hand[side].norm();
      human.gloves[side] = DefaultHand(side, length * between(0.9, 1.1));
    }
    human.props = 0b1010;
  }
  return human;
}

void ExpectSameShape(const Primitive& written, const Isometry3d& frame, const Geometry& read,
                     const std::string& where) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(written.rpy.z(), Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(written.rpy.y(), Vector3d::UnitY()) *
                                Eigen::AngleAxisd(written.rpy.x(), Vector3d::UnitX()))
                                   .toRotationMatrix();
  EXPECT_EQ(frame.translation(), written.center) << where;
  EXPECT_LT((frame.linear() - turn).norm(), 1e-12) << where;
  switch (written.kind) {
    case Primitive::Kind::kBox:
      EXPECT_EQ(read.kind, Geometry::Kind::kBox) << where;
      EXPECT_EQ(read.size, written.size) << where;
      break;
    case Primitive::Kind::kCylinder:
      EXPECT_EQ(read.kind, Geometry::Kind::kCylinder) << where;
      EXPECT_EQ(read.size.head<2>(), written.size.head<2>()) << where;
      break;
    case Primitive::Kind::kSphere:
      EXPECT_EQ(read.kind, Geometry::Kind::kSphere) << where;
      EXPECT_EQ(read.size.x(), written.size.x()) << where;
      break;
  }
}

void ExpectSameShapes(const std::vector<Primitive>& written, const Link& link,
                      const Eigen::Vector4d& color) {
  ASSERT_EQ(link.visuals.size(), written.size()) << link.name;
  ASSERT_EQ(link.collisions.size(), written.size()) << link.name;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const Visual& visual = link.visuals[i];
    ExpectSameShape(written[i], visual.link_from_visual, visual.geometry, link.name);
    ExpectSameShape(written[i], link.collisions[i].link_from_collision, link.collisions[i].geometry,
                    link.name);
    ASSERT_TRUE(visual.rgba) << link.name;
    EXPECT_LT((*visual.rgba - color).norm(), 1e-6) << link.name;  // urdfdom keeps floats
  }
}

class Read {
 public:
  explicit Read(const HumanModel& human) : robot_(ParseUrdf(WriteUrdf(human))) {
    for (const Link& link : robot_.links) links_[link.name] = &link;
    for (const RobotJoint& joint : robot_.joints) joints_[joint.name] = &joint;
  }
  const RobotModel& robot() const { return robot_; }
  const Link& link(const std::string& name) const { return *links_.at(name); }

  // A joint of a chain, as it was meant; returns its child.
  std::string Expect(const std::string& name, RobotJoint::Type type, const std::string& parent,
                     const Vector3d& offset, int axis, const AxisLimit& limit) {
    const auto found = joints_.find(name);
    if (found == joints_.end()) {
      ADD_FAILURE() << name << " is missing";
      return "";
    }
    const RobotJoint& joint = *found->second;
    ++checked_;
    EXPECT_EQ(joint.type, type) << name;
    EXPECT_EQ(joint.parent_link, parent) << name;
    EXPECT_EQ(joint.parent_from_joint.translation(), offset) << name;
    EXPECT_EQ(joint.parent_from_joint.linear(), Eigen::Matrix3d::Identity()) << name;
    EXPECT_EQ(joint.axis, Vector3d(Eigen::Matrix3d::Identity().col(axis))) << name;
    EXPECT_TRUE(joint.limits) << name;
    if (!joint.limits) return joint.child_link;
    EXPECT_EQ(joint.limits->lower, limit.lower) << name;
    EXPECT_EQ(joint.limits->upper, limit.upper) << name;
    EXPECT_EQ(joint.limits->effort, limit.effort) << name;
    EXPECT_EQ(joint.limits->velocity, limit.velocity) << name;
    return joint.child_link;
  }
  int checked() const { return checked_; }

 private:
  RobotModel robot_;
  std::map<std::string, const Link*> links_;
  std::map<std::string, const RobotJoint*> joints_;
  int checked_ = 0;
};

TEST(HumanUrdf, KeepsEveryValueThroughUrdfdomAndTheReader) {
  std::mt19937 random(17);
  const Eigen::Vector4d body(0.78, 0.80, 0.84, 1);
  const Eigen::Vector4d glove(0.55, 0.60, 0.68, 1);
  const std::string name = "skeleton";
  for (int trial = 0; trial < 20; ++trial) {
    const HumanModel human = RandomHuman(random);
    Read read(human);
    EXPECT_EQ(read.robot().name, name);
    for (int i = 0; i < kSegmentCount; ++i) {
      const Link& link = read.link(LinkName(name, i));
      const SegmentInertia& segment = human.body[At(i)];
      ASSERT_TRUE(link.inertial) << link.name;
      EXPECT_EQ(link.inertial->mass, segment.mass) << link.name;
      EXPECT_EQ(link.inertial->link_from_inertial.translation(), segment.com_in_link) << link.name;
      EXPECT_EQ(link.inertial->link_from_inertial.linear(), Eigen::Matrix3d::Identity());
      EXPECT_EQ(link.inertial->inertia, segment.inertia_about_com) << link.name;
      const bool is_gloved = human.gloves[kRight] && (i == kRightHand || i == kLeftHand);
      if (is_gloved) continue;  // drawn by its fingers
      ExpectSameShapes(PrimitiveBody(human.skeleton, i), link, body);
    }
    for (int joint = 0; joint < kJointCount; ++joint) {
      std::string parent = LinkName(name, ParentOf(joint));
      Vector3d offset = human.skeleton.origin_in_parent[At(ChildOf(joint))];
      for (const int axis : {1, 0, 2}) {
        parent = read.Expect(JointName(name, joint, axis), RobotJoint::Type::kRevolute, parent,
                             offset, axis, LimitOf(joint, axis));
        offset.setZero();
      }
      EXPECT_EQ(parent, LinkName(name, ChildOf(joint)));
    }
    for (const Side side : {kRight, kLeft}) {
      if (!human.gloves[side]) continue;
      for (int finger = 0; finger < kFingersPerHand; ++finger) {
        const int above = kFingerParents[At(finger)];
        std::string parent =
            above < 0 ? LinkName(name, HandSegmentOf(side)) : FingerLinkName(name, side, above);
        Vector3d offset = human.gloves[side]->origin_in_parent[At(finger)];
        for (const int axis : {1, 0, 2}) {
          parent =
              read.Expect(FingerJointName(name, side, finger, axis), RobotJoint::Type::kRevolute,
                          parent, offset, axis, LimitOf(KindOf(finger), side == kLeft, axis));
          offset.setZero();
        }
        EXPECT_EQ(parent, FingerLinkName(name, side, finger));
        if (finger == 0) continue;  // whose hand's link collides in its place
        ExpectSameShapes(FingerPrimitives(*human.gloves[side], finger), read.link(parent), glove);
      }
    }
    const std::size_t gloves = human.gloves[kRight] ? 120 : 0;
    EXPECT_EQ(static_cast<std::size_t>(read.checked()), 66 + gloves);
    EXPECT_EQ(read.robot().joints.size(), 66 + gloves + 6 * human.props.count());
    EXPECT_EQ(read.robot().links.size(), read.robot().joints.size() + 1);
  }
}

TEST(HumanUrdf, ConnectsAPropToThePelvisBySixJointsThatEveryReaderAccepts) {
  HumanModel human = Human();
  human.props = 0b0100;
  Read read(human);
  const RobotModel& robot = read.robot();
  EXPECT_TRUE(robot.notes.empty()) << robot.notes.front();
  // Wherever it may be, along and about every axis of the pelvis; shown as a small slate box, which
  // is no load class.
  constexpr double kFar = 100, kTurn = 2 * M_PI;
  std::string above = "skeleton_pelvis";
  int step = 0;
  for (const std::string& joint : PropJointNames("skeleton", 2)) {
    const bool slides = step < 3;
    const int axis = std::array<int, 6>{0, 1, 2, 1, 0, 2}[At(step++)];
    above = read.Expect(
        joint, slides ? RobotJoint::Type::kPrismatic : RobotJoint::Type::kRevolute, above,
        Vector3d::Zero(), axis,
        slides ? AxisLimit{-kFar, kFar, 1000, 100} : AxisLimit{-kTurn, kTurn, 100, 100});
  }
  const Link& prop = read.link("skeleton_prop3");
  Primitive box;
  box.size = Vector3d::Constant(0.06);
  ExpectSameShapes({box}, prop, Eigen::Vector4d(0.42, 0.46, 0.54, 1));
  EXPECT_FALSE(prop.inertial);
  std::string parent = "skeleton_pelvis";
  const auto names = PropJointNames("skeleton", 2);
  for (std::size_t i = 0; i < names.size(); ++i) {
    bool is_there = false;
    for (const RobotJoint& joint : robot.joints) {
      if (joint.name != names[i]) continue;
      is_there = true;
      EXPECT_EQ(joint.parent_link, parent);
      EXPECT_EQ(joint.type, i < 3 ? RobotJoint::Type::kPrismatic : RobotJoint::Type::kRevolute);
      parent = joint.child_link;
      break;
    }
    EXPECT_TRUE(is_there) << names[i];
  }
  EXPECT_EQ(parent, "skeleton_prop3");
}

TEST(HumanUrdf, IsTheSameTextForTheSameBodyAndHasNoFingersWithoutGloves) {
  const std::string text = WriteUrdf(Human());
  EXPECT_EQ(text, WriteUrdf(Human()));
  for (const char* word : {"carpus", "prop", "glove"}) {
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
}

TEST(HumanUrdf, HasTheMassOfTheBodyInEveryVariant) {
  std::mt19937 random(18);
  for (int trial = 0; trial < 40; ++trial) {
    HumanModel human = RandomHuman(random);
    human.mass_inside_joints = trial % 2 == 1;
    double mass = 0;
    std::size_t weightless = 0;
    for (const Link& link : ParseUrdf(WriteUrdf(human)).links) {
      mass += link.mass;
      weightless += link.mass == 0;
      if (!link.inertial) continue;
      const Vector3d i = link.inertial->inertia.diagonal();
      EXPECT_GT(link.mass, 1e-6) << link.name << ": older versions of Gazebo take that for nothing";
      EXPECT_GT(i.minCoeff(), 0) << link.name;
      EXPECT_LE(2 * i.maxCoeff(), i.sum()) << link.name << " breaks the triangle inequality";
    }
    EXPECT_NEAR(mass, TotalMass(human.body), 1e-9);
    const std::size_t of_gloves = human.gloves[kRight] ? 120 : 0;
    const std::size_t all = 2 * kJointCount + of_gloves + 6 * human.props.count();
    EXPECT_EQ(weightless, human.mass_inside_joints ? 0 : all);
  }
}

// What the links inside a joint get, the joint's own segment lacks: together they are the segment.
TEST(HumanUrdf, SharesASegmentsMassWithTheLinksInsideItsJointForSimulators) {
  HumanModel human = Human();
  human.mass_inside_joints = true;
  const Read read(human);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const SegmentInertia& whole = human.body[At(ChildOf(joint))];
    double mass = 0;
    Vector3d moment = Vector3d::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const std::string& name :
         {LinkName("skeleton", ChildOf(joint)), LinkInside(JointName("skeleton", joint, 1)),
          LinkInside(JointName("skeleton", joint, 0))}) {
      ASSERT_TRUE(read.link(name).inertial) << name;
      const Inertial& part = *read.link(name).inertial;
      EXPECT_GT(part.mass, 0.009 * whole.mass) << name;
      mass += part.mass;
      moment += part.mass * part.link_from_inertial.translation();
      inertia += part.inertia;
    }
    EXPECT_NEAR(mass, whole.mass, 1e-12);
    EXPECT_LT((moment / mass - whole.com_in_link).norm(), 1e-12);
    EXPECT_LT((inertia - whole.inertia_about_com).norm(), 1e-12);
  }
}

bool Holds(const Collision& collision, const Vector3d& point) {
  const Vector3d p = collision.link_from_collision.inverse() * point;
  const Vector3d& size = collision.geometry.size;
  switch (collision.geometry.kind) {
    case Geometry::Kind::kBox: return (p.cwiseAbs() - 0.5 * size).maxCoeff() <= 0;
    case Geometry::Kind::kCylinder:
      return p.head<2>().norm() <= size.x() && std::abs(p.z()) <= 0.5 * size.y();
    case Geometry::Kind::kSphere: return p.norm() <= size.x();
    case Geometry::Kind::kMesh: break;
  }
  return false;
}

TEST(HumanUrdf, HasOneSetOfVisualsAndOneCollisionShapePerGlovedHand) {
  HumanModel human = Human();
  human.gloves[kLeft] = DefaultHand(kLeft, 0.19);
  for (const char* folder : {"", "/some/folder"}) {
    human.mesh_folder = folder;
    const Read read(human);
    EXPECT_TRUE(read.link("skeleton_left_hand").visuals.empty());
    EXPECT_EQ(read.link("skeleton_left_hand").collisions.size(), 1u);
    EXPECT_EQ(read.link("skeleton_left_carpus").visuals.size(), 1u);
    EXPECT_TRUE(read.link("skeleton_left_carpus").collisions.empty());
    EXPECT_FALSE(read.link("skeleton_left_second_mp").visuals.empty());
    EXPECT_FALSE(read.link("skeleton_right_hand").visuals.empty()) << "it wears no glove";
  }
  EXPECT_EQ(Read(human).link("skeleton_left_second_mp").visuals[0].geometry.mesh_uri,
            "file:///some/folder/left_second_mp.stl");
}

TEST(HumanUrdf, HasEveryCentreOfMassInsideItsSegmentsCollisionShapes) {
  std::mt19937 random(19);
  for (int trial = 0; trial < 40; ++trial) {
    for (const Link& link : ParseUrdf(WriteUrdf(RandomHuman(random))).links) {
      if (!link.inertial) continue;
      const Vector3d com = link.inertial->link_from_inertial.translation();
      const bool is_inside =
          std::any_of(link.collisions.begin(), link.collisions.end(),
                      [&](const Collision& collision) { return Holds(collision, com); });
      EXPECT_TRUE(is_inside) << link.name << ": " << com.transpose();
    }
  }
}

TEST(JointLimits, AreSymmetricAndIncludeTheNPoseOnEveryAxisOfEveryJoint) {
  for (int joint = 0; joint < kJointCount; ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      const AxisLimit limit = LimitOf(joint, axis);
      EXPECT_LT(limit.lower, 0) << JointName("", joint, axis) << " cannot stand in the N-pose";
      EXPECT_GT(limit.upper, 0);
      EXPECT_GT(limit.effort, 0);
      EXPECT_GT(limit.velocity, 0);
    }
  }
  const AxisLimit right = LimitOf(jRightHip, 0);
  const AxisLimit left = LimitOf(jLeftHip, 0);
  EXPECT_EQ(left.lower, -right.upper);
  EXPECT_EQ(left.upper, -right.lower);
  EXPECT_EQ(LimitOf(jRightKnee, 1).upper, LimitOf(jLeftKnee, 1).upper);
  EXPECT_GT(LimitOf(jLeftKnee, 1).upper, 2.3) << "a knee bends by 135 degrees and more";
  EXPECT_LT(LimitOf(jLeftKnee, 1).lower, 0);
}

}  // namespace
}  // namespace kinescope::urdf
