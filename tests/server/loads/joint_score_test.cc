#include "server/loads/joint_score.h"

#include <gmock/gmock.h>

#include "core/system/errors.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

Strength Of(Sex sex, Percentile percentile = Percentile::k50, double factor = 1) {
  return {sex, factor, percentile};
}

double CapacityOf(int joint, const Vector3d& moment, const Strength& strength,
                  const LinkPoses& links = Posed({})) {
  return ScoreJoint(joint, moment, links, strength).capacity;
}

// In the N-pose every link is upright: moments about world axes are those of the joint.
TEST(Score, NamesTheGoverningDirection) {
  struct Row {
    int joint;
    Vector3d moment;
    const char* channel;
  };
  const Row rows[] = {{jL5S1, {0, 10, 0}, "flexion"},
                      {jL5S1, {0, -10, 0}, "extension"},
                      {jL5S1, {10, 0, 0}, "bend right"},
                      {jL5S1, {0, 0, 10}, "turn left"},
                      {jT1C7, {0, 0, -10}, "turn right"},
                      {jRightHip, {0, -10, 0}, "flexion"},
                      {jRightHip, {-10, 0, 0}, "abduction"},
                      {jLeftHip, {10, 0, 0}, "abduction"},
                      {jLeftHip, {0, 0, 10}, "external rotation"},
                      {jRightHip, {0, 0, 10}, "internal rotation"},
                      {jRightKnee, {0, 10, 0}, "flexion"},
                      {jLeftAnkle, {0, 10, 0}, "plantar flexion"},
                      {jRightElbow, {0, -10, 0}, "flexion"},
                      {jRightWrist, {10, 0, 0}, "palmar flexion"},
                      {jLeftWrist, {10, 0, 0}, "dorsal flexion"},
                      {jLeftWrist, {0, -10, 0}, "radial deviation"},
                      {jRightShoulder, {10, 0, 0}, "elevation"},
                      {jRightShoulder, {0, 0, 10}, "internal rotation"},
                      {jLeftShoulder, {0, 0, 10}, "external rotation"}};
  for (const Row& row : rows) {
    EXPECT_EQ(ScoreJoint(row.joint, row.moment, Posed({}), {}).channel, row.channel)
        << kJoints[urdf::At(row.joint)].mvn_name << " " << row.moment.transpose();
  }
  for (const int joint : {jRightC7Shoulder, jLeftBallFoot}) {
    EXPECT_EQ(ScoreJoint(joint, {9, 9, 9}, Posed({}), {}).ratio, 0) << "not scored";
  }
}

// 10 N·m about all three axes: the ratios are those of the capacities.
TEST(Score, NamesTheSecondDirectionWithItsRatio) {
  const Score hip = ScoreJoint(jRightHip, {-10, -10, 10}, Posed({}), {});
  EXPECT_EQ(hip.channel, "internal rotation");
  EXPECT_NEAR(hip.ratio, 10.0 / 60, 1e-12);
  EXPECT_EQ(hip.next_channel, "abduction");
  EXPECT_NEAR(hip.next_ratio, 10.0 / 97, 1e-12);
  // The same, found in another order.
  const Score other = ScoreJoint(jRightHip, {0, -100, 10}, Posed({}), {});
  EXPECT_EQ(other.channel, "flexion");
  EXPECT_EQ(other.next_channel, "internal rotation");
  EXPECT_NEAR(other.next_ratio, 10.0 / 60, 1e-12);
  const Score knee = ScoreJoint(jRightKnee, {0, 10, 0}, Posed({}), {});
  EXPECT_EQ(knee.next_channel, "") << "has one direction only";
  EXPECT_TRUE(std::isnan(knee.next_ratio));
}

TEST(Strength, DependsOnSexPercentileAndPerson) {
  const Vector3d extension(0, -10, 0);
  EXPECT_NEAR(CapacityOf(jL5S1, extension, Of(Sex::kMale)), 234, 1e-9);
  EXPECT_NEAR(CapacityOf(jL5S1, extension, Of(Sex::kFemale)), 184, 1e-9);
  EXPECT_NEAR(CapacityOf(jL5S1, extension, Of(Sex::kFemale, Percentile::k5)), 71, 1e-9);
  EXPECT_NEAR(CapacityOf(jL5S1, extension, Of(Sex::kMale, Percentile::k95)), 503, 1e-9);
  EXPECT_NEAR(CapacityOf(jL5S1, extension, Of(Sex::kMale, Percentile::k5, 0.8)), 0.8 * 164, 1e-9);
  EXPECT_NEAR(CapacityOf(jRightKnee, {0, 10, 0}, Of(Sex::kFemale, Percentile::k5)), 22, 1e-9);
  // The shoulder's formula, scaled as the single values of the abducted arm are.
  const LinkPoses raised = ArmForward();
  EXPECT_NEAR(CapacityOf(jRightShoulder, {0, -10, 0}, Of(Sex::kMale), raised), 90 - 0.47 * 90,
              1e-9);
  EXPECT_NEAR(CapacityOf(jRightShoulder, {0, -10, 0}, Of(Sex::kFemale, Percentile::k5), raised),
              0.5 * (90 - 0.47 * 90) * 15 / 37, 1e-9);
}

TEST(Strength, IsScaledLikeTheOthersWithoutPublishedPercentiles) {
  for (const Sex sex : {Sex::kMale, Sex::kFemale}) {
    const double median = CapacityOf(jRightWrist, {10, 0, 0}, Of(sex));
    const double weak = CapacityOf(jRightWrist, {10, 0, 0}, Of(sex, Percentile::k5));
    const double strong = CapacityOf(jRightWrist, {10, 0, 0}, Of(sex, Percentile::k95));
    // Between the least and the most that the published ones shrink and grow.
    EXPECT_GT(weak, 0.33 * median);
    EXPECT_LT(weak, 0.71 * median);
    EXPECT_GT(strong, 1.34 * median);
    EXPECT_LT(strong, 2.15 * median);
    const double neck = CapacityOf(jT1C7, {0, 10, 0}, Of(sex, Percentile::k5)) /
                        CapacityOf(jT1C7, {0, 10, 0}, Of(sex));
    EXPECT_NEAR(neck, weak / median, 1e-12);
  }
}

TEST(Strength, IsRejectedOutsideItsLimits) {
  EXPECT_EQ(FindDefect(Of(Sex::kMale)), "");
  for (const double factor : {0.0, -1.0, 7.0, std::nan("")}) {
    EXPECT_THAT(FindDefect(Of(Sex::kMale, Percentile::k50, factor)),
                ::testing::HasSubstr("capacity factor"));
  }
}

TEST(ScoreNorm, UsesTheWeakerDirection) {
  const Vector3d moment(3, 4, 12);
  EXPECT_NEAR(ScoreNorm(jL5S1, moment, Posed({}), {}).ratio, 13.0 / 143, 1e-12);
  EXPECT_NEAR(ScoreNorm(jRightAnkle, moment, Posed({}), {}).ratio, 13.0 / 43, 1e-12);
  EXPECT_NEAR(ScoreNorm(jLeftShoulder, moment, Posed({}), {}).ratio, 13.0 / 90, 1e-12);
  EXPECT_NEAR(ScoreNorm(jLeftWrist, moment, Posed({}), {}).ratio, 13.0 / 7.1, 1e-12);
}

TEST(LumbarLoad, IsConvertedToARatioByItsLimits) {
  EXPECT_NEAR(LumbarRatio({3400, 0}), 0.30, 1e-12);
  EXPECT_NEAR(LumbarRatio({1700, 100}), 0.15, 1e-12);
  EXPECT_NEAR(LumbarRatio({6400, 0}), 0.60, 1e-12);
  EXPECT_GT(LumbarRatio({6500, 0}), 0.60);
  EXPECT_NEAR(LumbarRatio({500, -1000}), 0.30, 1e-12);
  EXPECT_NEAR(LumbarRatio({500, 9000}), 0.60, 1e-12) << "shear has no upper limit to pass";
  EXPECT_EQ(LumbarRatio({-100, 0}), 0) << "pulled, as on a bar";
}

}  // namespace
}  // namespace kinescope::loads::testing
