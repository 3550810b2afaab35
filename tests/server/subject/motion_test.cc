// What holds for every motion of the subject, at every time and stature.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/system/errors.h"
#include "tests/server/subject/subject_checks.h"
#include "urdf/body_parameters.h"

namespace kinescope::subject {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::Index;

constexpr double kLapSecs = 2 * M_PI * 1.5 / 1.2;

std::vector<double> RandomTimes(int count, double up_to) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> seconds(0, up_to);
  std::vector<double> times(static_cast<std::size_t>(count));
  for (double& time : times) time = seconds(random);
  return times;
}

// The turn from `a` to `b` in world axes, as axis times angle.
Vector3d TurnBetween(const Quaterniond& a, const Quaterniond& b) {
  Quaterniond turn = b * a.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  return sine == 0 ? Vector3d(Vector3d::Zero())
                   : Vector3d(turn.vec() * (2 * std::atan2(sine, turn.w()) / sine));
}

class EveryMotion : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Subject, EveryMotion, ::testing::ValuesIn(MotionNames()),
                         [](const auto& motion) { return motion.param; });

TEST_P(EveryMotion, HasVelocitiesAndAccelerationsThatAreDerivativesOfThePose) {
  const auto motion = MakeMotion(GetParam());
  // Differences of the poses themselves: independent of how the derivatives came about.
  constexpr double kStep = 1e-5;
  for (const double t : RandomTimes(300, 16)) {
    const BodySample before = motion->At(t - kStep);
    const BodySample now = motion->At(t);
    const BodySample after = motion->At(t + kStep);
    const auto slope = [&](const Vector3d& a, const Vector3d& b) -> Vector3d {
      return (b - a) / (2 * kStep);
    };
    for (std::size_t i = 0; i < now.segments.size(); ++i) {
      SCOPED_TRACE(::testing::Message() << "segment " << i << " at " << t << " s");
      const SegmentState& a = before.segments[i];
      const SegmentState& b = after.segments[i];
      const SegmentState& s = now.segments[i];
      ASSERT_LT((slope(a.position, b.position) - s.velocity).norm(), 1e-6);
      ASSERT_LT((slope(a.velocity, b.velocity) - s.acceleration).norm(), 1e-3);
      ASSERT_LT(
          (TurnBetween(a.orientation, b.orientation) / (2 * kStep) - s.angular_velocity).norm(),
          1e-5);
      ASSERT_LT((slope(a.angular_velocity, b.angular_velocity) - s.angular_acceleration).norm(),
                1e-2);
    }
    ASSERT_LT((slope(before.com->position, after.com->position) - now.com->velocity).norm(), 1e-6);
    ASSERT_LT((slope(before.com->velocity, after.com->velocity) - now.com->acceleration).norm(),
              1e-3);
  }
}

TEST_P(EveryMotion, HasContinuousAccelerationsEvenAtPeriodEnds) {
  const auto motion = MakeMotion(GetParam());
  // A step stands out against what continuous acceleration can change by in so short a time; the
  // hardest blow is a heel's, about two thirds of these.
  constexpr double kStep = 5e-4;
  constexpr double kMaxJerk = 1.4e4;         // m/s^3
  constexpr double kMaxAngularJerk = 4.5e4;  // rad/s^3
  BodySample last = motion->At(-0.1);
  for (double t = -0.1 + kStep; t < 8.1; t += kStep) {
    const BodySample now = motion->At(t);
    for (std::size_t i = 0; i < now.segments.size(); ++i) {
      const SegmentState& a = last.segments[i];
      const SegmentState& b = now.segments[i];
      ASSERT_LT((b.acceleration - a.acceleration).norm(), kMaxJerk * kStep)
          << "segment " << i << " at " << t << " s";
      ASSERT_LT((b.angular_acceleration - a.angular_acceleration).norm(), kMaxAngularJerk * kStep)
          << "segment " << i << " at " << t << " s";
      ASSERT_GT(a.orientation.dot(b.orientation), 0.99)
          << "the quaternion of segment " << i << " changes its sign at " << t << " s";
    }
    last = now;
  }
}

TEST_P(EveryMotion, HasSegmentsThatMeetExactlyInTheirJoints) {
  for (const double height : {0.5, 1.75, 2.5}) {
    const auto motion = MakeMotion(GetParam(), height);
    const urdf::Skeleton& skeleton = *motion->character().skeleton;
    EXPECT_EQ(skeleton, urdf::DefaultSkeleton(height));
    for (const double t : RandomTimes(100, 16)) {
      const urdf::LinkPoses links = LinkPosesOf(motion->At(t));
      for (int i = 1; i < urdf::kSegmentCount; ++i) {
        const urdf::Pose& parent = links[Index(urdf::kSegments[Index(i)].parent)];
        const Vector3d joint =
            parent.position + parent.orientation * skeleton.origin_in_parent[Index(i)];
        ASSERT_LT((links[Index(i)].position - joint).norm(), 1e-12)
            << "segment " << i << " at " << t;
        ASSERT_NEAR(links[Index(i)].orientation.norm(), 1, 1e-12);
      }
    }
  }
}

TEST_P(EveryMotion, IsProportionalToTheStature) {
  const auto reference = MakeMotion(GetParam(), 1.75);
  for (const double height : {0.5, 2.5}) {
    const auto motion = MakeMotion(GetParam(), height);
    for (const double t : RandomTimes(50, 16)) {
      const BodySample a = reference->At(t);
      const BodySample b = motion->At(t);
      for (std::size_t i = 0; i < a.segments.size(); ++i) {
        ASSERT_LT((a.segments[i].position * height / 1.75 - b.segments[i].position).norm(), 1e-12);
        ASSERT_LT(TurnBetween(a.segments[i].orientation, b.segments[i].orientation).norm(), 1e-9);
      }
    }
  }
}

TEST_P(EveryMotion, KeepsTheFeetAboveTheFloor) {
  const auto motion = MakeMotion(GetParam());
  for (double t = 0; t < kLapSecs; t += 2e-3) {
    const BodySample sample = motion->At(t);
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      const auto foot = testing::FootOf(sample, *motion->character().skeleton, side);
      ASSERT_GE(foot.lowest(), -1e-4) << (side == urdf::kRight ? "right" : "left") << " at " << t;
    }
  }
}

TEST_P(EveryMotion, IsTheSameInAnyOrderOfTimes) {
  const auto motion = MakeMotion(GetParam());
  const auto other = MakeMotion(GetParam());
  const BodySample first = motion->At(3.21);
  other->At(-17);
  motion->At(1e6);
  for (const BodySample& again : {motion->At(3.21), other->At(3.21)}) {
    for (std::size_t i = 0; i < first.segments.size(); ++i) {
      ASSERT_EQ(first.segments[i].position, again.segments[i].position);
      ASSERT_EQ(first.segments[i].orientation.coeffs(), again.segments[i].orientation.coeffs());
      ASSERT_EQ(first.segments[i].acceleration, again.segments[i].acceleration);
    }
    EXPECT_EQ(first.stamp_nanos, again.stamp_nanos);
  }
}

TEST_P(EveryMotion, ContainsTheCentreOfMassOfItsBody) {
  const auto motion = MakeMotion(GetParam());
  const auto body =
      urdf::MakeBodyParameters({urdf::Sex::kMale, 75.0}, *motion->character().skeleton);
  for (const double t : RandomTimes(20, 8)) {
    const BodySample sample = motion->At(t);
    const urdf::LinkPoses links = LinkPosesOf(sample);
    Vector3d com = Vector3d::Zero();
    for (std::size_t i = 0; i < links.size(); ++i) {
      com += body[i].mass / 75.0 * (links[i].position + links[i].orientation * body[i].com_in_link);
    }
    EXPECT_LT((sample.com->position - com).norm(), 1e-12);
    EXPECT_TRUE(sample.com->has_derivatives);
    EXPECT_TRUE(sample.has_linear);
    EXPECT_TRUE(sample.has_angular);
  }
}

// What joints of a healthy adult can do (degrees, MVN's x, y, z), a little generous.
struct Range {
  Vector3d least, most;
};
Range RangeOf(int joint) {
  using namespace urdf;
  switch (joint) {
    case jL5S1:
    case jL4L3:
    case jL1T12: return {{-12, -8, -10}, {12, 8, 22}};
    case jT9T8: return {{-12, -15, -10}, {12, 15, 20}};
    case jT1C7:
    case jC1Head: return {{-20, -40, -30}, {20, 40, 30}};
    case jRightC7Shoulder:
    case jLeftC7Shoulder: return {{-10, -20, -15}, {30, 25, 15}};
    case jRightShoulder:
    case jLeftShoulder: return {{-20, -70, -50}, {180, 80, 180}};
    case jRightElbow:
    case jLeftElbow: return {{-15, 0, -1}, {15, 160, 145}};
    case jRightWrist:
    case jLeftWrist: return {{-32, -5, -65}, {30, 5, 70}};
    case jRightHip:
    case jLeftHip: return {{-25, -45, -20}, {45, 35, 132}};
    case jRightKnee:
    case jLeftKnee: return {{-5, -15, -1}, {5, 15, 145}};
    case jRightAnkle:
    case jLeftAnkle: return {{-25, -25, -50}, {25, 25, 45}};
    default: return {{-5, -5, -40}, {5, 5, 45}};  // balls of the feet
  }
}

TEST_P(EveryMotion, StaysWithinTheRangeOfMotionOfEveryJoint) {
  const auto motion = MakeMotion(GetParam());
  for (double t = 0; t < kLapSecs; t += 5e-3) {
    const BodySample sample = motion->At(t);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      const Range range = RangeOf(joint);
      const Vector3d& angles = (*sample.streamed_angles_deg)[Index(joint)];
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GE(angles[axis], range.least[axis])
            << urdf::kJoints[Index(joint)].mvn_name << " axis " << axis << " at " << t;
        ASSERT_LE(angles[axis], range.most[axis])
            << urdf::kJoints[Index(joint)].mvn_name << " axis " << axis << " at " << t;
      }
    }
  }
}

TEST(Motion, RejectsAnUnknownNameAndListsTheKnownOnes) {
  try {
    MakeMotion("dance");
    FAIL() << "took it";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("dance"));
    for (const std::string& name : MotionNames()) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(name));
    }
  }
}

TEST(Motion, HasIdentityLinksInTheNPoseAndIdentitySegmentsInTheTPose) {
  const urdf::LinkPoses links = LinkPosesOf(MakeMotion("n_pose")->At(1.5));
  for (const urdf::Pose& link : links) {
    EXPECT_LT(link.orientation.angularDistance(Quaterniond::Identity()), 1e-9);
  }
  const BodySample t_pose = MakeMotion("t_pose")->At(1.5);
  for (const SegmentState& segment : t_pose.segments) {
    EXPECT_LT(segment.orientation.angularDistance(Quaterniond::Identity()), 1e-9);
    EXPECT_EQ(segment.velocity, Vector3d::Zero());
    EXPECT_EQ(segment.angular_acceleration, Vector3d::Zero());
  }
  EXPECT_NEAR(t_pose.segments[urdf::kRightHand].position.y(), -0.73, 1e-12);
}

}  // namespace
}  // namespace kinescope::subject
