#include <gtest/gtest.h>

#include <algorithm>

#include "server/loads/load_estimator.h"
#include "tests/server/subject/subject_checks.h"
#include "urdf/body_parameters.h"
#include "urdf/skin/limbs.h"

namespace kinescope::subject {
namespace {

using Eigen::Vector3d;
using testing::FootOf;
using testing::Index;

constexpr double kPeriodSecs = 8;

Vector3d GripOf(const urdf::LinkPoses& links, int hand) {
  return links[Index(hand)].position + links[Index(hand)].orientation * Vector3d(0, 0, -0.080);
}

TEST(Lift, KeepsBothFeetFlatAndFixedOnTheFloor) {
  const auto motion = MakeMotion("lift");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  const BodySample start = motion->At(0);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const auto first = FootOf(start, skeleton, side);
    EXPECT_NEAR(first.heel.z(), 0, 1e-12);
    EXPECT_NEAR(first.tip.z(), 0, 1e-12);
    for (double t = 0; t < kPeriodSecs; t += 1e-2) {
      const auto foot = FootOf(motion->At(t), skeleton, side);
      ASSERT_LT((foot.heel - first.heel).norm(), 1e-12) << "at " << t;
      ASSERT_LT((foot.ball - first.ball).norm(), 1e-12) << "at " << t;
      ASSERT_LT((foot.tip - first.tip).norm(), 1e-12) << "at " << t;
    }
  }
}

TEST(Lift, MovesABoxFromTheFloorToTheChestAndBack) {
  const auto motion = MakeMotion("lift");
  const auto box = [&](double t) -> Vector3d {
    const urdf::LinkPoses links = LinkPosesOf(motion->At(t));
    return (GripOf(links, urdf::kRightHand) + GripOf(links, urdf::kLeftHand)) / 2;
  };
  EXPECT_NEAR(box(1.9).z(), 0.15, 1e-6);
  EXPECT_GT(box(1.9).x(), 0.35);
  EXPECT_GT(box(3.2).z(), 1.0);
  EXPECT_GT(box(4.2).y(), 0.3) << "not turned to the left";
  EXPECT_NEAR(box(6.45).z(), 0.15, 1e-6);
  EXPECT_NEAR((box(6.45) - box(1.9)).norm(), 0, 1e-6) << "put down elsewhere";
}

TEST(Lift, KeepsTheDistanceOfTheHandsWhileTheyHoldTheBox) {
  const auto motion = MakeMotion("lift");
  for (double t = 1.8; t < 6.4; t += 1e-2) {
    const urdf::LinkPoses links = LinkPosesOf(motion->At(t));
    const double width = (GripOf(links, urdf::kRightHand) - GripOf(links, urdf::kLeftHand)).norm();
    ASSERT_NEAR(width, 0.32, 1e-9) << "at " << t;
  }
}

// m between the surfaces of two limbs at rest; negative: one is in the other.
double GapBetween(const urdf::LinkPoses& links, const skin::LimbShape& a,
                  const skin::LimbShape& b) {
  const auto at = [&](const skin::LimbShape& limb, double share) {
    const auto in_world = [&](const skin::LimbEnd& end) -> Vector3d {
      const urdf::Pose& link = links[Index(end.segment)];
      return link.position + link.orientation * end.point;
    };
    return Vector3d((1 - share) * in_world(limb.start) + share * in_world(limb.end));
  };
  double gap = 9;
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = static_cast<double>(i) / kSteps;
    const double radius = (1 - s) * a.start.radius + s * a.end.radius;
    const Vector3d from = at(b, 0), along = at(b, 1) - from, p = at(a, s);
    const double t = std::clamp(along.dot(p - from) / along.squaredNorm(), 0.0, 1.0);
    const double other = (1 - t) * b.start.radius + t * b.end.radius;
    gap = std::min(gap, (p - from - t * along).norm() - radius - other);
  }
  return gap;
}

TEST(Lift, KeepsTheArmsOutOfTheLegs) {
  for (const double height : {1.55, 1.75, 1.95}) {
    const auto motion = MakeMotion("lift", height);
    const skin::LimbShapes limbs = skin::LimbShapesOf(*motion->character().skeleton, {});
    for (double t = 0; t < kPeriodSecs; t += 0.05) {
      const urdf::LinkPoses links = LinkPosesOf(motion->At(t));
      for (int arm = skin::kRightUpperArmLimb; arm <= skin::kLeftHandLimb; ++arm) {
        for (const int leg : {skin::kRightThighLimb, skin::kRightShankLimb, skin::kLeftThighLimb,
                              skin::kLeftShankLimb}) {
          const double gap = GapBetween(links, limbs[Index(arm)], limbs[Index(leg)]);
          EXPECT_GT(gap, 0) << "limb " << arm << " is in limb " << leg << " at " << t << " s, "
                            << height << " m";
        }
      }
    }
  }
}

TEST(Lift, StaysInBalance) {
  const auto motion = MakeMotion("lift");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  const auto right = FootOf(motion->At(0), skeleton, urdf::kRight);
  const auto left = FootOf(motion->At(0), skeleton, urdf::kLeft);
  for (double t = 0; t < kPeriodSecs; t += 1e-2) {
    const Vector3d com = motion->At(t).com->position;
    ASSERT_GT(com.x(), std::max(right.heel.x(), left.heel.x()) - 0.01) << "falls back at " << t;
    ASSERT_LT(com.x(), std::min(right.ball.x(), left.ball.x()) + 0.02) << "falls forward at " << t;
    ASSERT_GT(com.y(), right.heel.y()) << "at " << t;
    ASSERT_LT(com.y(), left.heel.y()) << "at " << t;
  }
}

TEST(Lift, ShowsEveryLoadClass) {
  const auto motion = MakeMotion("lift");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  const auto body = urdf::MakeBodyParameters({}, skeleton);
  loads::LoadEstimator estimator;
  std::array<LoadClass, urdf::kScoredJoints.size()> worst;
  std::array<LoadClass, urdf::kScoredJoints.size()> upright;
  worst.fill(LoadClass::kUnknown);
  for (int frame = 0; frame < 60 * 16; ++frame) {  // two rounds at 60 Hz; the second is settled
    const BodySample sample = motion->At(frame / 60.0);
    const loads::LoadResult& result =
        estimator.Update(sample, LinkPosesOf(sample), {skeleton, body}, loads::LoadSettings());
    for (std::size_t i = 0; i < worst.size(); ++i) {
      const LoadClass now = result.loads[i].load_class;
      ASSERT_NE(now, LoadClass::kUnknown) << result.loads[i].reason << " at " << frame / 60.0;
      worst[i] = std::max(worst[i], now);
      if (frame == 8 * 60 + 12) upright[i] = now;  // has stood for longer than any peak is held
    }
  }
  const auto of = [](const auto& classes, int joint) {
    const auto found = std::find(urdf::kScoredJoints.begin(), urdf::kScoredJoints.end(), joint);
    return classes[static_cast<std::size_t>(found - urdf::kScoredJoints.begin())];
  };
  EXPECT_EQ(of(worst, urdf::jRightKnee), LoadClass::kHigh);
  EXPECT_EQ(of(worst, urdf::jL5S1), LoadClass::kMedium);
  EXPECT_EQ(of(worst, urdf::jRightShoulder), LoadClass::kMedium);
  EXPECT_EQ(of(worst, urdf::jLeftShoulder), LoadClass::kMedium);
  EXPECT_EQ(of(worst, urdf::jRightElbow), LoadClass::kLow);
  for (const int joint : {urdf::jL5S1, urdf::jRightKnee, urdf::jRightShoulder}) {
    EXPECT_EQ(of(upright, joint), LoadClass::kLow) << urdf::kJoints[Index(joint)].mvn_name;
  }
}

}  // namespace
}  // namespace kinescope::subject
