#include <gtest/gtest.h>

#include <optional>

#include "tests/server/subject/subject_checks.h"

namespace kinescope::subject {
namespace {

using Eigen::Vector3d;
using testing::FootOf;
using testing::FootPoints;
using testing::Index;

constexpr double kWholeLapSecs = 2 * M_PI * 1.5 / 1.2;
constexpr double kStrideSecs = kWholeLapSecs / 7;
constexpr double kFrameSecs = 2e-3;

TEST(Walk, KeepsTheContactPointOfTheFootFixed) {
  const auto motion = MakeMotion("walk");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    std::optional<Vector3d> heel, tip;  // where it came down, while it is down
    int contacts = 0;
    for (double t = 0; t < kWholeLapSecs; t += kFrameSecs) {
      const FootPoints foot = FootOf(motion->At(t), skeleton, side);
      for (auto [point, held] : {std::pair{&foot.heel, &heel}, std::pair{&foot.tip, &tip}}) {
        if (point->z() > 1e-9) {
          held->reset();
        } else if (!*held) {
          *held = *point;
          ++contacts;
        } else {
          ASSERT_LT((*point - **held).norm(), 1e-3) << "slides at " << t;
        }
      }
    }
    EXPECT_NEAR(contacts, 14, 1) << "a heel and a toe contact in each of seven strides";
  }
}

TEST(Walk, HasAFootOnTheFloorAlwaysAndBothForAQuarterOfTheTime) {
  const auto motion = MakeMotion("walk");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  int both = 0;
  int frames = 0;
  for (double t = 0; t < kWholeLapSecs; t += kFrameSecs, ++frames) {
    const BodySample sample = motion->At(t);
    const bool right = FootOf(sample, skeleton, urdf::kRight).lowest() < 1e-6;
    const bool left = FootOf(sample, skeleton, urdf::kLeft).lowest() < 1e-6;
    ASSERT_TRUE(right || left) << "flies at " << t;
    both += right && left ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(both) / frames, 0.24, 0.05);
}

TEST(Walk, StartsContactWithTheHeelAndEndsItWithTheToes) {
  const auto motion = MakeMotion("walk");
  const urdf::Skeleton& skeleton = *motion->character().skeleton;
  const auto right = [&](double phase) {
    return FootOf(motion->At(phase * kStrideSecs), skeleton, urdf::kRight);
  };
  EXPECT_NEAR(right(0.0).heel.z(), 0, 1e-9);
  EXPECT_GT(right(0.0).tip.z(), 0.05);
  EXPECT_NEAR(right(0.2).heel.z(), 0, 1e-9);
  EXPECT_NEAR(right(0.2).tip.z(), 0, 1e-9);
  EXPECT_GT(right(0.6).heel.z(), 0.10);
  EXPECT_NEAR(right(0.6).tip.z(), 0, 1e-9);
}

TEST(Walk, CirclesTheOriginAtItsSpeedAndReturns) {
  const auto motion = MakeMotion("walk");
  double way = 0;
  for (double t = 0; t < kWholeLapSecs; t += kFrameSecs) {
    const SegmentState pelvis = motion->At(t).segments[urdf::kPelvis];
    const double radius = pelvis.position.head<2>().norm();
    ASSERT_NEAR(radius, 1.5, 0.05) << "at " << t;
    // Slower over the standing leg, faster into the next step.
    ASSERT_NEAR(pelvis.velocity.head<2>().norm(), 1.2, 0.30) << "at " << t;
    way += pelvis.velocity.head<2>().norm() * kFrameSecs;
  }
  EXPECT_NEAR(way / kWholeLapSecs, 1.2, 0.03);
  const BodySample start = motion->At(0.25);
  const BodySample lap_later = motion->At(0.25 + kWholeLapSecs);
  for (std::size_t i = 0; i < start.segments.size(); ++i) {
    EXPECT_LT((start.segments[i].position - lap_later.segments[i].position).norm(), 1e-9);
    EXPECT_LT((start.segments[i].acceleration - lap_later.segments[i].acceleration).norm(), 1e-6);
  }
}

TEST(Walk, SwingsTheArmsAgainstTheLegs) {
  const auto motion = MakeMotion("walk");
  // How far in front of the pelvis, along where it faces.
  const auto ahead = [&](const BodySample& sample, int segment) {
    const SegmentState& pelvis = sample.segments[urdf::kPelvis];
    return (pelvis.orientation.conjugate() *
            (sample.segments[Index(segment)].position - pelvis.position))
        .x();
  };
  for (int stride = 0; stride < 7; ++stride) {
    const BodySample strike = motion->At(stride * kStrideSecs);  // of the right heel
    EXPECT_GT(ahead(strike, urdf::kRightFoot) - ahead(strike, urdf::kLeftFoot), 0.4);
    EXPECT_LT(ahead(strike, urdf::kRightHand) - ahead(strike, urdf::kLeftHand), -0.3);
  }
}

}  // namespace
}  // namespace kinescope::subject
