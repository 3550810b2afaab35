#include "core/skeleton_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/subject/subject.h"
#include "urdf/kinematics.h"

namespace kinescope {
namespace {

using urdf::At;

constexpr double kHz = 60;

// The walking subject, `height_m` tall, at sample `n` of 60 a second.
BodySample Walker(int n, double height_m) {
  BodySample sample = subject::MakeMotion("walk", height_m)->At(n / kHz);
  sample.stamp_nanos = std::llround(n * 1e9 / kHz);
  return sample;
}

double ShankOf(const urdf::Skeleton& skeleton) {
  return skeleton.origin_in_parent[urdf::kRightFoot].norm();
}

TEST(SkeletonWatch, MeasuresTheFirstSampleOnceForTheSamePerson) {
  SkeletonWatch watch;
  const auto first = watch.Look(Walker(0, 1.8));
  ASSERT_TRUE(first);
  EXPECT_NEAR(ShankOf(*first), ShankOf(urdf::DefaultSkeleton(1.8)), 1e-9);
  std::mt19937 random(5);
  std::normal_distribution<double> shift(0, 0.002);  // as measured people have it
  for (int n = 1; n < 600; ++n) {
    BodySample sample = Walker(n, 1.8);
    for (SegmentState& segment : sample.segments) {
      segment.position += Eigen::Vector3d(shift(random), shift(random), shift(random));
    }
    EXPECT_FALSE(watch.Look(sample)) << "sample " << n;
  }
}

TEST(SkeletonWatch, MeasuresAgainOneSecondAfterAChangeOfPerson) {
  SkeletonWatch watch;
  ASSERT_TRUE(watch.Look(Walker(0, 1.6)));
  for (int n = 1; n <= static_cast<int>(kHz); ++n) {
    EXPECT_FALSE(watch.Look(Walker(n, 1.9))) << "after " << (n - 1) / kHz << " s";
  }
  const auto other = watch.Look(Walker(static_cast<int>(kHz) + 1, 1.9));
  ASSERT_TRUE(other);
  EXPECT_NEAR(ShankOf(*other), ShankOf(urdf::DefaultSkeleton(1.9)), 1e-9);
  EXPECT_NEAR(other->height, 1.9, 0.1) << "end points come from the stature";
  EXPECT_FALSE(watch.Look(Walker(100, 1.9)));
}

TEST(SkeletonWatch, IgnoresShortLivedAndUnstableLengths) {
  SkeletonWatch watch;
  ASSERT_TRUE(watch.Look(Walker(0, 1.7)));
  for (int n = 1; n < 600; ++n) {
    const bool is_disturbed = n % 60 < 50;
    EXPECT_FALSE(watch.Look(Walker(n, is_disturbed ? 1.9 : 1.7))) << "sample " << n;
  }
  for (int n = 600; n < 1200; ++n) {  // other lengths in every half second
    EXPECT_FALSE(watch.Look(Walker(n, n / 30 % 2 == 0 ? 1.9 : 2.1))) << "sample " << n;
  }
}

TEST(SkeletonWatch, DetectsALegThatIsTwoCentimetresLonger) {
  for (const double longer : {0.01, 0.03}) {
    SkeletonWatch watch;
    ASSERT_TRUE(watch.Look(Walker(0, 1.75)));
    int announced = 0;
    for (int n = 1; n < 200; ++n) {
      BodySample sample = Walker(n, 1.75);
      const Eigen::Vector3d along = (sample.segments[urdf::kRightFoot].position -
                                     sample.segments[urdf::kRightLowerLeg].position)
                                        .normalized();
      for (const int segment : {urdf::kRightFoot, urdf::kRightToe}) {
        sample.segments[At(segment)].position += longer * along;
      }
      announced += watch.Look(sample).has_value();
    }
    EXPECT_EQ(announced, longer > SkeletonWatch::kOtherLength ? 1 : 0) << longer << " m";
  }
}

TEST(SkeletonWatch, WaitsForASampleWithHumanLengths) {
  SkeletonWatch watch;
  BodySample heap;  // everything in one point
  EXPECT_FALSE(watch.Look(heap));
  BodySample giant = Walker(1, 1.75);
  for (SegmentState& segment : giant.segments) segment.position *= 3;
  EXPECT_FALSE(watch.Look(giant));
  EXPECT_TRUE(watch.Look(Walker(2, 1.75)));
  for (int n = 3; n < 200; ++n) {  // and keeps the skeleton when what comes later does not
    giant.stamp_nanos = Walker(n, 1.75).stamp_nanos;
    EXPECT_FALSE(watch.Look(giant));
  }
}

}  // namespace
}  // namespace kinescope
