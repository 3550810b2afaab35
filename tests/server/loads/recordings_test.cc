// Cases K and L of joint-loads.md 6: real recordings.
#include <fstream>
#include <sstream>
#include <vector>

#include "server/mvn/open.h"
#include "tests/recording_sink.h"
#include "tests/server/loads/loads_testing.h"
#include "tests/shared_data.h"

namespace kinescope::loads::testing {
namespace {

using kinescope::testing::SharedData;

// One sheet of the exported recording of P005, without the frame numbers.
std::vector<std::vector<double>> ReadSheet(const std::string& name) {
  std::ifstream file(SharedData("excel-export-P005/" + name + ".csv"));
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  std::getline(file, line);  // names
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::getline(cells, cell, ',');
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

Vector3d VectorAt(const std::vector<double>& row, int i) {
  const std::size_t at = 3 * urdf::At(i);
  return {row.at(at), row.at(at + 1), row.at(at + 2)};
}

std::vector<BodySample> ReadP005() {
  const auto positions = ReadSheet("segment_position");
  const auto quaternions = ReadSheet("segment_orientation_quat");
  const auto velocities = ReadSheet("segment_velocity");
  const auto accelerations = ReadSheet("segment_acceleration");
  const auto turns = ReadSheet("segment_angular_velocity");
  const auto turn_rates = ReadSheet("segment_angular_acceleration");
  const auto coms = ReadSheet("center_of_mass");
  std::vector<BodySample> samples(positions.size());
  for (std::size_t frame = 0; frame < samples.size(); ++frame) {
    BodySample& sample = samples[frame];
    sample.stamp_nanos = 1 + std::llround(1e9 / 60 * static_cast<double>(frame));
    sample.has_linear = sample.has_angular = true;
    sample.com.emplace().position = VectorAt(coms[frame], 0);
    for (int i = 0; i < kSegmentCount; ++i) {
      const double* const q = &quaternions[frame].at(4 * urdf::At(i));
      sample.segments[urdf::At(i)] = {
          VectorAt(positions[frame], i),  Quaterniond(q[0], q[1], q[2], q[3]),
          VectorAt(velocities[frame], i), VectorAt(accelerations[frame], i),
          VectorAt(turns[frame], i),      VectorAt(turn_rates[frame], i)};
    }
  }
  return samples;
}

// 6.12: offsets as measured in a frame; nobody measured the ends.
Skeleton P005Skeleton(const BodySample& sample) {
  const LinkPoses links = LinkPosesOf(sample);
  Skeleton skeleton;
  for (int i = 1; i < kSegmentCount; ++i) {
    const Pose& parent = links[urdf::At(kSegments[urdf::At(i)].parent)];
    skeleton.origin_in_parent[urdf::At(i)] =
        parent.orientation.conjugate() * (links[urdf::At(i)].position - parent.position);
  }
  skeleton.head_top_in_head = {0, 0, 0.175};
  for (const Side side : {kRight, kLeft}) {
    skeleton.finger_tip_in_hand[side] = {0, 0, -0.175};
    skeleton.heel_in_foot[side] = {-0.042, 0, -0.085};
    skeleton.toe_tip_in_toe[side] = {0.065, 0, 0};
  }
  skeleton.height = 1.65;
  return skeleton;
}

// Every frame within 5 mm on each axis, all on average within 3 mm.
void ExpectSameCom(const std::vector<BodySample>& samples, const Skeleton& skeleton, Sex sex) {
  BodyDescription description;
  description.sex = sex;
  const BodyParameters body = MakeBodyParameters(description, skeleton);
  LoadEstimator estimator;
  double sum = 0;
  for (const BodySample& sample : samples) {
    const LoadResult& result =
        estimator.Update(sample, LinkPosesOf(sample), {skeleton, body}, LoadSettings());
    ASSERT_TRUE(result.forces.com_minus_mvn);
    EXPECT_LT(result.forces.com_minus_mvn->cwiseAbs().maxCoeff(), 0.005)
        << "frame " << sample.counter << ": " << result.forces.com_minus_mvn->transpose();
    EXPECT_FALSE(result.forces.com_disagrees);
    sum += result.forces.com_minus_mvn->norm();
  }
  const double mean = sum / static_cast<double>(samples.size());
  ::testing::Test::RecordProperty("mean_mm", std::to_string(1e3 * mean));
  EXPECT_LT(mean, 0.003);
}

class CaseK : public ::testing::TestWithParam<const char*> {};

TEST_P(CaseK, ComputesTheCentreOfMassOfMvn) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam());
  const auto source = mvn::OpenMvnx(SharedData(GetParam()).string());
  kinescope::testing::RecordingSink sink;
  while (source->Poll(std::chrono::milliseconds(0), sink) == Source::State::kMore) {
  }
  ASSERT_FALSE(sink.samples.empty());
  ASSERT_TRUE(sink.characters.back().skeleton);
  for (const Sex sex : {Sex::kMale, Sex::kFemale}) {
    ExpectSameCom(sink.samples, *sink.characters.back().skeleton, sex);
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, CaseK,
                         ::testing::Values("mvnx/Meri-020.mvnx", "mvnx/test_mocap.mvnx"),
                         [](const auto& one) { return one.index == 0 ? "Meri" : "TestMocap"; });

TEST(CaseKExport, ComputesTheCentreOfMassOfTheExportedRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_position.csv");
  const std::vector<BodySample> samples = ReadP005();
  ASSERT_EQ(samples.size(), 103U);
  ExpectSameCom(samples, P005Skeleton(samples[0]), Sex::kMale);
}

// Somebody who stands: contacts, filter and floor have no reason to doubt it in any frame, and what
// moves adds little to what stands (joint-loads.md 2.3).
TEST(RealRecording, OfAStandingPersonIsDynamicWithFootContactInEverySample) {
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_position.csv");
  const std::vector<BodySample> samples = ReadP005();
  const Skeleton skeleton = P005Skeleton(samples[0]);
  const BodyParameters body = MakeBodyParameters({}, skeleton);
  LoadEstimator dynamic, still;
  LoadSettings still_settings;
  still_settings.motion.dynamic = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const LinkPoses links = LinkPosesOf(samples[i]);
    const LoadResult moving = dynamic.Update(samples[i], links, {skeleton, body}, LoadSettings());
    ASSERT_TRUE(moving.forces.is_dynamic) << "frame " << i << ": " << moving.forces.why_static;
    ASSERT_EQ(moving.forces.why_no_ground, "") << "frame " << i;
    EXPECT_GT(moving.forces.cop_inside, 0) << "frame " << i;
    EXPECT_TRUE(moving.forces.feet[kRight].touches_floor &&
                moving.forces.feet[kLeft].touches_floor);
    const LoadResult& standing = still.Update(samples[i], links, {skeleton, body}, still_settings);
    for (const int joint : urdf::kScoredJoints) {
      EXPECT_LT((At(moving, joint).moment - At(standing, joint).moment).norm(), 5) << "frame " << i;
    }
  }
}

TEST(CaseL, GivesTheExpectedLoadsForARecordedSample) {
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_position.csv");
  const BodySample sample = ReadP005().at(50);
  const Skeleton skeleton = P005Skeleton(sample);
  BodyDescription description;
  description.mass_kg = 70;
  const BodyParameters body = MakeBodyParameters(description, skeleton);
  const auto estimate = [&](bool dynamic) {
    LoadSettings settings = Unclamped();
    settings.motion.dynamic = dynamic;
    LoadEstimator estimator;  // its filter begins at the frame's own values
    return estimator.Update(sample, LinkPosesOf(sample), {skeleton, body}, settings);
  };
  const LoadResult still = estimate(false), moving = estimate(true);
  struct Row {
    int joint;
    Vector3d still, moving;
  };
  const Row rows[] = {{jL5S1, {-0.425, -4.399, 0}, {-0.794, -4.366, 0.002}},
                      {jRightC7Shoulder, {-4.289, 1.023, 0}, {-4.404, 1.064, -0.012}},
                      {jRightHip, {-52.871, -10.000, 0}, {-52.239, -9.791, 0.164}},
                      {jRightKnee, {-14.157, 20.750, 0}, {-13.502, 20.808, 0.129}},
                      {jRightAnkle, {24.751, 58.521, 0}, {25.312, 58.582, 0.151}},
                      {jLeftHip, {2.167, 18.767, 0}, {2.225, 18.532, -0.035}},
                      {jLeftKnee, {3.396, 15.416, 0}, {3.520, 15.462, 0.024}},
                      {jLeftAnkle, {7.420, 10.753, 0}, {7.560, 10.830, 0.031}}};
  constexpr double kTolerance = 0.02;  // N m, 6.12
  for (const Row& row : rows) {
    EXPECT_LT((At(still, row.joint).moment - row.still).cwiseAbs().maxCoeff(), kTolerance)
        << kJoints[urdf::At(row.joint)].mvn_name << ": " << At(still, row.joint).moment.transpose();
    EXPECT_LT((At(moving, row.joint).moment - row.moving).cwiseAbs().maxCoeff(), kTolerance)
        << kJoints[urdf::At(row.joint)].mvn_name << ": "
        << At(moving, row.joint).moment.transpose();
  }
  EXPECT_LT((still.forces.com_of_model - Vector3d(0.1846, -0.0253, 0.9061)).norm(), 2e-4);
  const auto& feet = still.forces.feet;
  EXPECT_NEAR(still.forces.ground_force.z(), 686.700, kForceTolerance);
  EXPECT_NEAR(feet[kRight].force.z(), 582.439, 0.1);
  EXPECT_NEAR(feet[kLeft].force.z(), 104.261, 0.1);
  EXPECT_LT((feet[kRight].cop.head<2>() - Vector2d(0.1334, -0.0436)).norm(), 1e-4);
  EXPECT_LT((feet[kLeft].cop.head<2>() - Vector2d(0.4704, 0.0768)).norm(), 1e-4);
  ExpectRatio(still, jRightHip, 0.530);
  EXPECT_EQ(LoadOf(still, jRightHip).channel, "abduction");
  EXPECT_EQ(LoadOf(still, jRightHip).load_class, LoadClass::kMedium);
  ExpectRatio(still, jRightAnkle, 0.477);
  EXPECT_EQ(LoadOf(still, jRightAnkle).channel, "plantar flexion");
  ExpectRatio(still, jLeftKnee, 0.154);

  EXPECT_LT((moving.forces.ground_force - Vector3d(-0.366, -0.023, 685.814)).norm(),
            kForceTolerance);
  EXPECT_LT((moving.cop->head<2>() - Vector2d(0.1852, -0.0263)).norm(), kPointTolerance);
  EXPECT_NEAR(moving.forces.ground_free_moment, -0.160, 2e-3);
}

}  // namespace
}  // namespace kinescope::loads::testing
