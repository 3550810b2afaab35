// The worked examples of joint-loads.md 6 that need no recording, on its reference person R75.
#include "server/loads/equivalent_chain.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

void ExpectGround(const LoadResult& result, const Vector3d& force, const Vector2d& cop) {
  EXPECT_LT((result.forces.ground_force - force).norm(), kForceTolerance)
      << result.forces.ground_force.transpose();
  ASSERT_TRUE(result.cop) << result.forces.why_no_ground;
  EXPECT_LT((result.cop->head<2>() - cop).norm(), kPointTolerance) << result.cop->transpose();
}

double RightShare(const LoadResult& result) {
  return result.forces.feet[kRight].force.z() / result.forces.ground_force.z();
}

void ExpectFoot(const FootForce& foot, const Vector3d& force, const Vector2d& at) {
  EXPECT_LT((foot.force - force).norm(), kForceTolerance) << foot.force.transpose();
  EXPECT_LT((foot.cop.head<2>() - at).norm(), kPointTolerance) << foot.cop.transpose();
}

void ExpectForce(const LoadResult& result, int joint, const Vector3d& expected) {
  EXPECT_LT((At(result, joint).force - expected).norm(), kForceTolerance)
      << kJoints[urdf::At(joint)].mvn_name << ": " << At(result, joint).force.transpose();
}

TEST(WorkedExample, ANPoseNeedsNoMoments) {
  const LoadResult result = Estimate(Posed({}));
  EXPECT_LT((result.forces.com_of_model - Vector3d(0.0020, 0, 1.0079)).norm(), kPointTolerance);
  ExpectGround(result, {0, 0, 735.750}, {0.0020, 0});
  ExpectFoot(result.forces.feet[kRight], {0, 0, 367.875}, {0.0020, -0.085});
  ExpectFoot(result.forces.feet[kLeft], {0, 0, 367.875}, {0.0020, 0.085});
  for (const int joint : urdf::kScoredJoints) ExpectMoment(result, joint, Vector3d::Zero(), 1e-9);
  const std::map<int, double> force_z = {
      {jL5S1, 363.46},      {jT9T8, 195.64},      {jT1C7, 51.06},        {jRightShoulder, 36.35},
      {jRightElbow, 16.41}, {jRightHip, -221.76}, {jRightKnee, -325.94}, {jRightAnkle, -357.80}};
  for (const auto& [joint, expected] : force_z) ExpectForce(result, joint, {0, 0, expected});
}

TEST(WorkedExample, B0ArmIsHorizontallyForward) {
  const LoadResult result = Estimate(ArmForward());
  EXPECT_LT((result.forces.com_of_model - Vector3d(0.0172, 0, 1.0231)).norm(), kPointTolerance);
  ExpectGround(result, {0, 0, 735.750}, {0.0172, 0});
  const std::map<int, Vector3d> moments = {
      {jRightWrist, {0, -0.309, 0}},     {jRightElbow, {0, -2.794, 0}},
      {jRightShoulder, {0, -11.169, 0}}, {jRightC7Shoulder, {-6.553, -11.169, 0}},
      {jT9T8, {0, -11.169, 0}},          {jL5S1, {0, -11.169, 0}},
      {jRightHip, {0, 5.584, 0}},        {jRightKnee, {0, 5.584, 0}},
      {jRightAnkle, {0, 5.584, 0}},      {jLeftHip, {0, 5.584, 0}}};
  for (const auto& [joint, moment] : moments) ExpectMoment(result, joint, moment);
  const std::map<int, double> ratios = {
      {jRightWrist, 0.028}, {jRightElbow, 0.036}, {jRightShoulder, 0.234}, {jT9T8, 0.048},
      {jL5S1, 0.048},       {jRightHip, 0.029},   {jRightKnee, 0.056},     {jRightAnkle, 0.044}};
  for (const auto& [joint, ratio] : ratios) ExpectRatio(result, joint, ratio);
  EXPECT_EQ(LoadOf(result, jRightWrist).channel, "radial deviation");
  EXPECT_EQ(LoadOf(result, jRightShoulder).channel, "elevation");
  ASSERT_TRUE(result.forces.lumbar);
  EXPECT_NEAR(result.forces.lumbar->compression, 549.6, 0.1);
}

TEST(WorkedExample, B1RightHandHoldsFiveKilograms) {
  LoadSettings settings = Unclamped();
  settings.hands = Held(5);
  const LoadResult result = Estimate(ArmForward(), settings);
  ExpectGround(result, {0, 0, 784.80}, {0.0555, -0.0112});
  EXPECT_NEAR(RightShare(result), 0.5662, kPointTolerance);
  ExpectFoot(result.forces.feet[kLeft], {0, 0, 340.465}, {0.0555, 0.085});
  ExpectFoot(result.forces.feet[kRight], {0, 0, 444.335}, {0.0555, -0.085});
  struct Row {
    int joint;
    Vector3d moment;
    double ratio;
    LoadClass load_class;
  };
  const LoadClass low = LoadClass::kLow, medium = LoadClass::kMedium, high = LoadClass::kHigh;
  const Row rows[] = {
      {jRightWrist, {0, -4.233, 0}, 0.385, medium},   {jRightElbow, {0, -18.981, 0}, 0.247, low},
      {jRightShoulder, {0, -42.070, 0}, 0.882, high}, {jT9T8, {-8.829, -42.070, 0}, 0.180, low},
      {jL5S1, {-8.829, -42.070, 0}, 0.180, low},      {jRightHip, {0, 23.915, 0}, 0.126, low},
      {jRightKnee, {0, 23.915, 0}, 0.239, low},       {jRightAnkle, {0, 23.915, 0}, 0.190, low},
      {jLeftHip, {0, 18.155, 0}, 0.096, low},         {jLeftKnee, {0, 18.155, 0}, 0.182, low},
      {jLeftAnkle, {0, 18.155, 0}, 0.144, low}};
  for (const Row& row : rows) {
    ExpectMoment(result, row.joint, row.moment);
    ExpectRatio(result, row.joint, row.ratio);
    EXPECT_EQ(LoadOf(result, row.joint).load_class, row.load_class)
        << kJoints[urdf::At(row.joint)].mvn_name;
  }
  ExpectMoment(result, jRightC7Shoulder, {-13.910, -42.070, 0});
  EXPECT_NEAR(result.forces.lumbar->compression, 1129.0, 0.1);
  EXPECT_EQ(result.forces.hands[kRight].mass_kg, 5);
  EXPECT_LT((result.forces.hands[kRight].force - Vector3d(0, 0, -5 * kGravity)).norm(), 1e-9);
  // The shoulder in closed form.
  EXPECT_NEAR(At(result, jRightShoulder).moment.y(),
              -kGravity * (2.0325 * 0.5772 * 0.300 + 1.215 * (0.300 + 0.4574 * 0.250) +
                           0.4575 * (0.550 + 0.3624 * 0.190) + 5 * 0.630),
              kMomentTolerance);
}

TEST(WorkedExample, B1OverloadIsCausedByTheHandLoadOnly) {
  LoadSettings settings = Unclamped();
  settings.hands = Held(5);
  settings.metric = LoadMetric::kOverload;
  const LoadResult added = Estimate(ArmForward(), settings);
  const std::map<int, double> delta_over_capacity = {
      {jRightWrist, 3.924 / 11.0}, {jRightElbow, 16.187 / 77}, {jRightShoulder, 30.902 / 47.7},
      {jL5S1, 30.902 / 234},       {jRightHip, 18.331 / 190},  {jRightKnee, 18.331 / 100},
      {jRightAnkle, 18.331 / 126}, {jLeftKnee, 12.571 / 100}};
  for (const auto& [joint, ratio] : delta_over_capacity) ExpectRatio(added, joint, ratio);
  settings.hands = Held(0);
  const LoadResult nothing = Estimate(ArmForward(), settings);
  for (const JointLoad& load : nothing.loads) EXPECT_NEAR(load.ratio, 0, 1e-12) << load.joint;
  EXPECT_EQ(nothing.forces.metric, LoadMetric::kOverload);
}

TEST(WorkedExample, CTrunkIsBentForwardWithoutAndWithHandLoad) {
  struct Row {
    int joint;
    double bare, loaded, bare_ratio, loaded_ratio;
  };
  const Row rows[] = {
      {jL5S1, -66.290, -88.349, 0.283, 0.378},    {jT9T8, -15.973, -20.552, 0.068, 0.088},
      {jT1C7, -5.523, -5.523, 0.108, 0.108},      {jRightHip, 33.145, 44.174, 0.174, 0.232},
      {jRightKnee, 33.145, 44.174, 0.331, 0.442}, {jRightAnkle, 33.145, 44.174, 0.263, 0.351}};
  const LoadResult bare = Estimate(TrunkBent());
  LoadSettings settings = Unclamped();
  settings.hands = Held(5, 5);
  const LoadResult loaded = Estimate(TrunkBent(), settings);
  EXPECT_LT((bare.forces.com_of_model - Vector3d(0.0921, 0, 0.9706)).norm(), kPointTolerance);
  ExpectGround(bare, {0, 0, 735.75}, {0.0921, 0});
  ExpectGround(loaded, {0, 0, 833.85}, {0.1077, 0});
  for (const Row& row : rows) {
    ExpectMoment(bare, row.joint, {0, row.bare, 0});
    ExpectMoment(loaded, row.joint, {0, row.loaded, 0});
    ExpectRatio(bare, row.joint, row.bare_ratio);
    ExpectRatio(loaded, row.joint, row.loaded_ratio);
  }
  ExpectMoment(bare, jL4L3, {0, -44.626, 0});
  ExpectMoment(loaded, jL4L3, {0, -60.442, 0});
  ExpectMoment(bare, jC1Head, {0, -2.469, 0});
  ExpectMoment(bare, jRightC7Shoulder, {-6.553, 0, 0});
  ExpectMoment(loaded, jRightC7Shoulder, {-13.910, 0, 0});
  EXPECT_NEAR(At(loaded, jL5S1).force.z(), 461.56, kForceTolerance);
  EXPECT_NEAR(bare.forces.lumbar->compression, 1361.8, 0.1);
  EXPECT_NEAR(bare.forces.lumbar->shear, -257.0, 0.1);
  EXPECT_NEAR(loaded.forces.lumbar->compression, 1798.9, 0.1);
}

TEST(WorkedExample, DGroundReactionForceIsMeasured) {
  Measurements measured;
  measured.ground.emplace();
  measured.ground->force = {0, 0, 735.75};
  measured.ground->point = {0.05, 0, 0};
  measured.ground->stamp_nanos = 1;
  const LoadResult result = Estimate(Posed({}), Unclamped(), nullptr, measured);
  EXPECT_TRUE(result.forces.ground_is_measured);
  EXPECT_NEAR(RightShare(result), 0.5, 1e-9);
  for (const int joint : {jRightAnkle, jRightKnee, jRightHip, jLeftAnkle, jLeftKnee, jLeftHip}) {
    ExpectMoment(result, joint, {0, 17.668, 0});
  }
  ExpectRatio(result, jRightAnkle, 0.140);
  ExpectRatio(result, jRightKnee, 0.177);
  ExpectRatio(result, jRightHip, 0.093);
  EXPECT_EQ(LoadOf(result, jRightAnkle).channel, "plantar flexion");
  EXPECT_EQ(LoadOf(result, jRightKnee).channel, "flexion");
  EXPECT_EQ(LoadOf(result, jRightHip).channel, "extension");
  EXPECT_NEAR(result.forces.residual_force_share, 0, 1e-9);
  EXPECT_NEAR(result.forces.residual_moment_share * 75 * kGravity * 1.75, 35.336, kMomentTolerance);
}

TEST(WorkedExample, ESquatIsSymmetric) {
  const LoadResult result = Estimate(Squat());
  EXPECT_LT((result.forces.com_of_model - Vector3d(-0.0428, 0, 0.8093)).norm(), kPointTolerance);
  const std::map<int, std::pair<double, double>> moment_and_ratio = {
      {jL5S1, {-69.212, 0.296}},
      {jRightShoulder, {-11.169, 0.332}},
      {jRightHip, {45.284, 0.238}},
      {jRightKnee, {-68.791, 0.409}},
      {jRightAnkle, {-16.466, 0.383}}};
  for (const auto& [joint, expected] : moment_and_ratio) {
    EXPECT_NEAR(At(result, joint).moment.y(), expected.first, kMomentTolerance);
    ExpectRatio(result, joint, expected.second);
  }
  EXPECT_EQ(LoadOf(result, jRightKnee).channel, "extension");
  EXPECT_EQ(LoadOf(result, jRightAnkle).channel, "dorsiflexion");
  EXPECT_NEAR(result.forces.lumbar->compression, 1468.3, 0.1);
  EXPECT_NEAR(result.forces.lumbar->shear, -181.7, 0.1);
}

TEST(WorkedExample, FElbowFlexionIsDynamic) {
  const LinkPoses links = Posed({{kRightForeArm, Ry(-90)}, {kRightHand, Ry(-90)}});
  BodyMotion motion;
  for (const int i : {kRightForeArm, kRightHand}) {
    motion[urdf::At(i)].angular_velocity = {0, -4, 0};
    motion[urdf::At(i)].angular_acceleration = {0, -20, 0};
  }
  motion[kRightHand].acceleration = AccelerationAt(
      motion[kRightForeArm], links[kRightHand].position - links[kRightForeArm].position);
  EXPECT_LT((motion[kRightHand].acceleration - Vector3d(-4.0, 0, 5.0)).norm(), 1e-12);
  const LoadResult result = Estimate(links, Unclamped(), &motion);
  EXPECT_TRUE(result.forces.is_dynamic);
  ExpectGround(result, {-4.557, 0, 741.446}, {0.0145, -0.0014});
  EXPECT_NEAR(result.forces.ground_free_moment, -0.814, kMomentTolerance);
  EXPECT_NEAR(RightShare(result), 0.5081, kPointTolerance);
  ExpectMoment(result, jRightWrist, {0, -0.537, 0});
  ExpectMoment(result, jRightElbow, {0, -4.185, 0});
  ExpectMoment(result, jRightShoulder, {0, -2.818, 0});
  ExpectMoment(result, jT9T8, {-1.025, -3.119, -0.820});
  ExpectMoment(result, jL5S1, {-1.025, -4.267, -0.820});
  ExpectForce(result, jRightWrist, {-2.33, 0, 7.41});
  ExpectForce(result, jRightElbow, {-4.56, 0, 22.10});
  ExpectForce(result, jRightShoulder, {-4.56, 0, 42.04});
  ExpectForce(result, jT9T8, {-4.56, 0, 201.33});
  ExpectForce(result, jL5S1, {-4.56, 0, 369.16});

  LoadSettings settings = Unclamped();
  settings.motion.dynamic = false;
  const LoadResult still = Estimate(links, settings, &motion);
  EXPECT_FALSE(still.forces.is_dynamic);
  ExpectMoment(still, jRightElbow, {0, -2.794, 0});
}

TEST(WorkedExample, GWholeBodyAccelerates) {
  BodyMotion motion;
  for (SegmentMotion& segment : motion) segment.acceleration = {0.3, -0.2, 0.5};
  const LoadResult result = Estimate(Posed({}), Unclamped(), &motion);
  ExpectGround(result, {22.5, -15.0, 773.25}, {-0.0274, 0.0196});
  EXPECT_NEAR(result.forces.ground_free_moment, 0, 1e-9);
  EXPECT_NEAR(RightShare(result), 0.3850, kPointTolerance);
  const FootForce &left = result.forces.feet[kLeft], &right = result.forces.feet[kRight];
  EXPECT_LT((left.force - Vector3d(13.838, -9.225, 475.556)).norm(), kForceTolerance);
  EXPECT_LT((right.force - Vector3d(8.662, -5.775, 297.694)).norm(), kForceTolerance);
  ExpectMoment(result, jL5S1, {1.456, 2.184, 0});
  ExpectMoment(result, jRightHip, {4.688, -1.874, -0.173});
  ExpectMoment(result, jRightKnee, {2.805, -4.699, -0.173});
  ExpectMoment(result, jRightAnkle, {0.453, -8.226, -0.173});
  ExpectMoment(result, jLeftHip, {8.104, -1.616, -0.267});
  ExpectMoment(result, jLeftKnee, {4.616, -6.847, -0.267});
  ExpectMoment(result, jLeftAnkle, {0.729, -12.677, -0.267});
  ExpectRatio(result, jLeftAnkle, 0.295);
  EXPECT_EQ(LoadOf(result, jLeftAnkle).channel, "dorsiflexion");
  EXPECT_EQ(LoadOf(result, jLeftHip).channel, "abduction");
  EXPECT_EQ(LoadOf(result, jRightHip).channel, "adduction");
  EXPECT_NEAR(LoadOf(result, jRightHip).deciding_moment, -4.688, kMomentTolerance);
}

TEST(WorkedExample, HSplitDividesTheGroundReactionForce) {
  std::array<FootOnGround, 2> feet;
  feet[kLeft] = {{0.30, 0.10}, 1};
  feet[kRight] = {{-0.10, -0.12}, 1};
  const GroundSplit split = SplitGround({30, -10, 900}, {{0.12, 0.02}, 4}, feet);
  EXPECT_NEAR(split.right_share, 0.42994, 1e-5);
  const FootShare &left = split.feet[kLeft], &right = split.feet[kRight];
  EXPECT_LT((left.force - Vector3d(17.1017, -5.7006, 513.0518)).norm(), 1e-3);
  EXPECT_LT((right.force - Vector3d(12.8983, -4.2994, 386.9482)).norm(), 1e-3);
  EXPECT_LT((left.point - Vector2d(0.2920, 0.1146)).norm(), kPointTolerance);
  EXPECT_LT((right.point - Vector2d(-0.1080, -0.1054)).norm(), kPointTolerance);
  EXPECT_NEAR(left.free_moment, 2.2802, 1e-4);
  EXPECT_NEAR(right.free_moment, 1.7198, 1e-4);
}

// Case I, the hysteresis, is in load_meter_test.cc.

TEST(WorkedExample, JStaticallyEquivalentChainGivesTheCentreOfMass) {
  const EquivalentChain chain = EquivalentChainOf(Person(), Body());
  const std::map<int, Vector3d> expected = {{kPelvis, {0, 0, 0.058052}},
                                            {kL5, {0, 0, 0.041641}},
                                            {kL3, {0, 0, 0.030932}},
                                            {kT12, {0, 0, 0.024142}},
                                            {kT8, {0, 0, 0.020088}},
                                            {kNeck, {0, 0, 0.005870}},
                                            {kHead, {0, 0, 0.004745}},
                                            {kRightShoulder, {0, -0.008906, 0}},
                                            {kLeftShoulder, {0, 0.008906, 0}},
                                            {kLeftUpperArm, {0, 0, -0.011383}},
                                            {kRightForeArm, {0, 0, -0.003377}},
                                            {kRightHand, {0, 0, -0.000420}},
                                            {kLeftUpperLeg, {0, 0, -0.053468}},
                                            {kRightLowerLeg, {0, 0, -0.014565}},
                                            {kRightFoot, {0.000938, 0, -0.000581}},
                                            {kLeftToe, {0.000048, 0, 0}}};
  for (const auto& [segment, vector] : expected) {
    EXPECT_LT((chain[urdf::At(segment)] - vector).norm(), 1e-6)
        << kSegments[urdf::At(segment)].mvn_name << ": " << chain[urdf::At(segment)].transpose();
  }
  EXPECT_LT((CenterOfMassOf(chain, Squat()) - Vector3d(-0.042788, 0, 0.809282)).norm(), 1e-5);
}

}  // namespace
}  // namespace kinescope::loads::testing
