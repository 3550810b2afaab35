// What is written is what the joint angles of the samples are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/system/errors.h"
#include "server/subject/pose_text.h"
#include "tests/server/subject/subject_checks.h"
#include "urdf/anatomical_limits.h"
#include "urdf/joint_limits.h"

namespace kinescope::subject {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::Index;
using Angles = std::array<Vector3d, urdf::kJointCount>;

// As `convert` computes them from the poses.
Angles AnglesOf(const BodySample& sample) {
  return urdf::AnatomicalAngles(OrientationsOf(sample), urdf::AngleSequence::kZxy);
}

Angles AnglesOf(const std::string& pose) { return AnglesOf(MakePose(pose)->At(0)); }

std::string NameOf(int joint, int axis) {
  constexpr const char* kTrunk[] = {"lateral_bending", "axial_rotation", "flexion"};
  constexpr const char* kLimb[] = {"abduction", "rotation", "flexion"};
  const auto& axes = joint <= urdf::jC1Head ? kTrunk : kLimb;
  return std::string(urdf::kJoints[Index(joint)].ros_name) + "_" + axes[axis];
}

std::string Entry(const std::string& name, double value) {
  std::ostringstream text;
  text << name << "=" << value;
  return text.str();
}

double LowestOfFeet(const BodySample& sample, const urdf::Skeleton& skeleton) {
  const urdf::LinkPoses links = LinkPosesOf(sample);
  double lowest = 9;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const auto [heel, tip] = urdf::SolePoints(skeleton, links, side);
    Vector3d ball = skeleton.origin_in_parent[Index(urdf::FootSegmentOf(side)) + 1];
    ball.z() = skeleton.heel_in_foot[side].z();
    const urdf::Pose& foot = links[Index(urdf::FootSegmentOf(side))];
    lowest = std::min({lowest, heel.z(), tip.z(), (foot.position + foot.orientation * ball).z()});
  }
  return lowest;
}

constexpr double kTolerance = 1e-6;  // degrees

// One angle at a time, from both ends of its range to its middle; the other 65 stay.
TEST(WrittenPose, HasEveryAngleThatIsWritten) {
  for (const std::string base : {"n_pose", "squat", "sit"}) {
    const Angles rest = AnglesOf(base);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        const urdf::AngleRange range = urdf::AnatomicalRangeOf(joint, axis);
        // At 90 deg of abduction, and beyond, the angles are not unique.
        const double end = axis == 0 ? 89 : 179;
        for (const double share : {0.0, 0.3, 0.5, 0.9, 1.0}) {
          const double written =
              std::clamp(std::round(range.lower + share * (range.upper - range.lower)), -end, end);
          const std::string text = base + "," + Entry(NameOf(joint, axis), written);
          const Angles angles = AnglesOf(text);
          for (int other = 0; other < urdf::kJointCount; ++other) {
            Vector3d expected = rest[Index(other)];
            if (other == joint) expected[axis] = written;
            ASSERT_LT((angles[Index(other)] - expected).norm(), kTolerance)
                << text << ": " << urdf::kJoints[Index(other)].ros_name << " "
                << angles[Index(other)].transpose();
          }
        }
      }
    }
  }
}

TEST(WrittenPose, HasAllThreeAnglesOfAJoint) {
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const Vector3d written(7, joint % 2 == 0 ? 11 : -11, 13);
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
      text += (axis == 0 ? "" : ",") + Entry(NameOf(joint, axis), written[axis]);
    }
    EXPECT_LT((AnglesOf(text)[Index(joint)] - written).norm(), kTolerance) << text;
    EXPECT_LT(((*MakePose(text)->At(0).streamed_angles_deg)[Index(joint)] - written).norm(),
              kTolerance)
        << text;
  }
}

TEST(WrittenPose, RaisesAnArmSidewaysAboveTheShoulder) {
  const BodySample sample = MakePose("right_shoulder_abduction=150")->At(0);
  const urdf::LinkPoses links = LinkPosesOf(sample);
  const Vector3d along = links[urdf::kRightForeArm].position - links[urdf::kRightUpperArm].position;
  EXPECT_LT((along.normalized() - Vector3d(0, -0.5, std::sqrt(0.75))).norm(), 1e-9);
  const auto xzy = urdf::AnatomicalAngles(OrientationsOf(sample), urdf::AngleSequence::kXzy);
  EXPECT_LT((xzy[urdf::jRightShoulder] - Vector3d(150, 0, 0)).norm(), kTolerance);
}

TEST(WrittenPose, BendsInTheClinicalDirection) {
  const auto ends_of = [](const std::string& pose) { return LinkPosesOf(MakePose(pose)->At(0)); };
  const auto rest = ends_of("n_pose");
  for (const char* side : {"right_", "left_"}) {
    const bool is_left = side[0] == 'l';
    const std::size_t hand = is_left ? urdf::kLeftHand : urdf::kRightHand;
    const std::size_t foot = is_left ? urdf::kLeftFoot : urdf::kRightFoot;
    const double out = is_left ? 1 : -1;
    const auto moved = [&](const std::string& entry, std::size_t link) -> Vector3d {
      const auto posed = ends_of(side + entry);
      return (posed[link].position - posed[urdf::kPelvis].position) -
             (rest[link].position - rest[urdf::kPelvis].position);
    };
    EXPECT_GT(moved("elbow=90", hand).x(), 0.2) << "forward";
    EXPECT_GT(moved("shoulder=45", hand).x(), 0.3);
    EXPECT_GT(out * moved("shoulder_abduction=45", hand).y(), 0.3);
    EXPECT_GT(moved("hip=45", foot).x(), 0.4);
    EXPECT_GT(out * moved("hip_abduction=30", foot).y(), 0.3);
    EXPECT_LT(moved("knee=60", foot).x(), -0.3) << "back";
  }
  EXPECT_GT((ends_of("l5_s1=20")[urdf::kHead].position - rest[urdf::kHead].position).x(), 0.1);
}

TEST(WrittenPose, StandsOnTheFloorAtAnyAngles) {
  for (const char* text :
       {"n_pose", "squat", "left_hip=90,left_knee=90", "right_ankle=-50,left_ankle=-50",
        "right_ankle=-40,left_ankle=-40,right_ballfoot=-40,left_ballfoot=-40",
        "right_ballfoot=-90,left_ballfoot=-90,right_ankle=-20,left_ankle=-20",
        "vertical_pelvis=80,vertical_pelvis_lateral_bending=-30",
        "heading=123,x=-4,y=7,right_hip=20"}) {
    for (const double height : {0.5, 1.75, 2.5}) {
      const auto motion = MakePose(text, height);
      const BodySample sample = motion->At(0.3);
      EXPECT_NEAR(LowestOfFeet(sample, *motion->character().skeleton), 0, 1e-12) << text;
      for (const SegmentState& segment : sample.segments) {
        ASSERT_EQ(segment.velocity, Vector3d::Zero()) << text;
        ASSERT_EQ(segment.acceleration, Vector3d::Zero()) << text;
        ASSERT_EQ(segment.angular_velocity, Vector3d::Zero()) << text;
        ASSERT_EQ(segment.angular_acceleration, Vector3d::Zero()) << text;
      }
    }
  }
}

TEST(WrittenPose, IsItsBaseWhereNothingIsWritten) {
  for (const std::string& base : StaticPoseNames()) {
    const BodySample written = MakePose(base)->At(0), demo = MakeMotion(base)->At(0);
    for (std::size_t i = 0; i < demo.segments.size(); ++i) {
      EXPECT_LT((written.segments[i].position - demo.segments[i].position).norm(), 1e-4)
          << base << " " << i;
      EXPECT_LT(written.segments[i].orientation.angularDistance(demo.segments[i].orientation), 1e-7)
          << base << " " << i;
    }
  }
}

TEST(WrittenPose, FacesItsHeadingAtItsPlace) {
  const urdf::LinkPoses rest = LinkPosesOf(MakePose("squat,right_elbow=90")->At(0));
  const urdf::LinkPoses turned =
      LinkPosesOf(MakePose("squat,right_elbow=90,heading=90,x=2,y=-3")->At(0));
  const Quaterniond quarter(Eigen::AngleAxisd(M_PI_2, Vector3d::UnitZ()));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_LT((turned[i].position - (quarter * rest[i].position + Vector3d(2, -3, 0))).norm(),
              1e-9);
    EXPECT_LT(turned[i].orientation.angularDistance(quarter * rest[i].orientation), 1e-7);
  }
}

// The columns vertical_pelvis_angle_zxy_* of `convert`.
TEST(WrittenPose, TiltsThePelvisAgainstTheVertical) {
  for (const char* heading : {"0", "75"}) {
    const BodySample sample =
        MakePose("vertical_pelvis=40,vertical_pelvis_lateral_bending=15,heading=" +
                 std::string(heading))
            ->At(0);
    const auto angles = urdf::ErgonomicAngles(OrientationsOf(sample), urdf::AngleSequence::kZxy);
    const auto pelvis = static_cast<std::size_t>(urdf::ErgonomicAngle::kVerticalPelvis);
    EXPECT_LT((angles[pelvis] - Vector3d(15, 0, 40)).norm(), kTolerance)
        << angles[pelvis].transpose();
  }
}

// robot_state_publisher and simulators reject angles beyond the limits.
TEST(WrittenPose, StaysWithinTheLimitsOfTheUrdf) {
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      const urdf::AngleRange range = urdf::AnatomicalRangeOf(joint, axis);
      for (const double written : {std::ceil(range.lower), std::floor(range.upper)}) {
        const auto motion = MakePose(Entry(NameOf(joint, axis), written));
        const auto angles = urdf::AnglesFromPoses(LinkPosesOf(motion->At(0)), {});
        for (int link_axis = 0; link_axis < 3; ++link_axis) {
          const urdf::AxisLimit limit = urdf::LimitOf(joint, link_axis);
          EXPECT_GE(angles[Index(joint)][link_axis], limit.lower - 1e-6) << NameOf(joint, axis);
          EXPECT_LE(angles[Index(joint)][link_axis], limit.upper + 1e-6) << NameOf(joint, axis);
        }
      }
    }
  }
}

TEST(WrittenPose, IsASourceWithoutAnEnd) {
  struct Collected final : SampleSink {
    void OnCharacter(const Character& character) override { name = character.name; }
    void OnSample(const BodySample& sample) override { last = sample; }
    std::string name;
    BodySample last;
  } sink;
  const auto source = OpenPose(" right_elbow=90, \n left_knee=45", 60, 1.6);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(source->Poll(std::chrono::milliseconds(0), sink), Source::State::kMore);
  }
  EXPECT_EQ(source->description(), "pose:right_elbow=90,left_knee=45");
  EXPECT_EQ(source->nominal_rate_hz(), 60);
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(sink.name, "Pose");
  EXPECT_EQ(sink.last.counter, 99u);
  EXPECT_THROW(OpenPose("right_elbow=90", 0), SourceError);
  EXPECT_THROW(OpenPose("elbow", 60), SourceError);
}

}  // namespace
}  // namespace kinescope::subject
