// A recording with a file of measured forces has the loads that these forces cause.
#include "server/scene/recorded_forces.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/system/errors.h"
#include "server/scene/scene_builder.h"
#include "server/subject/subject.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "tests/server/wrenches/wrenches_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ReadScenes;
using testing::TempFolder;
using wrenches::testing::kHeader;
using wrenches::testing::WriteText;

std::string RowOf(double secs, const char* body, const Vector3d& force, const Vector3d& point,
                  const Vector3d& torque) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", secs, body, force.x(), force.y(),
                     force.z(), point.x(), point.y(), point.z(), torque.x(), torque.y(),
                     torque.z());
}

/// The computed forces on both feet, as a file of measured ones.
std::string FeetOf(const testing::Scenes& scenes) {
  std::string rows = kHeader;
  for (const auto& scene : scenes) {
    const FootForce& right = scene->people[0].forces.feet[urdf::kRight];
    const FootForce& left = scene->people[0].forces.feet[urdf::kLeft];
    const double secs = Secs(scene->stamp_nanos - scenes.front()->stamp_nanos);
    rows += RowOf(secs, "RightFoot", right.force, right.cop, {0, 0, right.free_moment});
    rows += RowOf(secs, "LeftFoot", left.force, left.cop, {0, 0, left.free_moment});
  }
  return rows;
}

class RecordedForcesTest : public ::testing::Test {
 protected:
  SceneOptions OptionsWith(const std::string& text, const std::string& name = "forces.csv") {
    SceneOptions options;
    options.wrenches.emplace();
    options.wrenches->path = folder_ / name;
    WriteText(options.wrenches->path, text);
    return options;
  }

  TempFolder folder_;
};

double FarthestMoment(const PersonState& a, const PersonState& b) {
  double farthest = 0;
  for (int joint = urdf::jRightHip; joint < urdf::kJointCount; ++joint) {
    farthest = std::max(
        farthest,
        (a.forces.joints[urdf::At(joint)].moment - b.forces.joints[urdf::At(joint)].moment).norm());
  }
  return farthest;
}

TEST_F(RecordedForcesTest, ComputedForcesOfTheFeetMeasuredAgainGiveTheSameLoadsOfTheLegs) {
  const testing::Scenes computed = ReadScenes("demo:lift", 3, {});
  const testing::Scenes measured = ReadScenes("demo:lift", 3, OptionsWith(FeetOf(computed)));
  ASSERT_EQ(measured.size(), computed.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const PersonState& person = measured[i]->people[0];
    EXPECT_TRUE(person.forces.ground_is_measured);
    EXPECT_FALSE(computed[i]->people[0].forces.ground_is_measured);
    EXPECT_EQ(person.forces.why_no_ground, "");
    EXPECT_LT(FarthestMoment(person, computed[i]->people[0]), 0.01) << "N·m, at sample " << i;
    EXPECT_LT(person.forces.residual_force_share, 1e-6);
  }
}

// The same forces with 20 % more on both feet do not fit the motion.
TEST_F(RecordedForcesTest, ForcesThatDoNotFitTheMotionLeaveTheLegsUnknown) {
  testing::Scenes computed = ReadScenes("demo:n_pose", 0.2, {});
  std::string rows = FeetOf(computed);
  const SceneOptions doubled = [&] {
    SceneOptions options = OptionsWith(rows);
    options.body.mass_kg = 60;
    return options;
  }();
  const testing::Scenes measured = ReadScenes("demo:n_pose", 0.2, doubled);
  EXPECT_EQ(measured[5]->people[0].forces.why_no_ground,
            "the measured ground force is inconsistent with the motion");
}

TEST_F(RecordedForcesTest, AForceOnAHandIsWhatAMassInTheHandWeighs) {
  SceneOptions held;
  held.loads.motion.dynamic = false;
  held.loads.hands.is_known = true;
  held.loads.hands.mass_kg[urdf::kLeft] = 5;
  std::string rows = kHeader;
  for (int i = 0; i <= 20; ++i) {
    rows += fmt::format("{},LeftHand,0,0,{},,,,0,0,0\n", 0.05 * i, -5 * loads::kGravity);
  }
  SceneOptions pulled = OptionsWith(rows);
  pulled.loads.motion.dynamic = false;
  const testing::Scenes expected = ReadScenes("demo:lift", 1, held);
  const testing::Scenes actual = ReadScenes("demo:lift", 1, pulled);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const BodyForces& forces = actual[i]->people[0].forces;
    EXPECT_TRUE(forces.hands[urdf::kLeft].is_measured);
    EXPECT_FALSE(forces.hands[urdf::kRight].is_measured);
    for (std::size_t joint = 0; joint < forces.joints.size(); ++joint) {
      EXPECT_LT(
          (forces.joints[joint].moment - expected[i]->people[0].forces.joints[joint].moment).norm(),
          1e-9);
    }
  }
}

TEST_F(RecordedForcesTest, AGapInTheFileIsAGapInTheMeasurement) {
  const testing::Scenes computed = ReadScenes("demo:n_pose", 1, {});
  std::string rows = kHeader;
  for (int i = 0; i <= 100; ++i) {
    const double secs = 0.01 * i;
    if (secs > 0.305 && secs < 0.595) continue;
    const FootForce& right = computed[0]->people[0].forces.feet[urdf::kRight];
    const FootForce& left = computed[0]->people[0].forces.feet[urdf::kLeft];
    rows += RowOf(secs, "RightFoot", right.force, right.cop, Vector3d::Zero());
    rows += RowOf(secs, "LeftFoot", left.force, left.cop, Vector3d::Zero());
    rows += fmt::format("{},RightHand,1,0,0,,,,0,0,0\n", secs);
  }
  const testing::Scenes scenes = ReadScenes("demo:n_pose", 1, OptionsWith(rows));
  for (const auto& scene : scenes) {
    const double secs = Secs(scene->stamp_nanos - scenes.front()->stamp_nanos);
    const PersonState& person = scene->people[0];
    const bool is_gap = secs > 0.301 && secs < 0.599;
    EXPECT_EQ(person.forces.ground_is_measured, !is_gap) << secs;
    EXPECT_EQ(person.forces.hands[urdf::kRight].is_measured, !is_gap) << secs;
    EXPECT_EQ(person.forces.joints[urdf::jRightElbow].why_unknown,
              is_gap ? "no data from the hand force sensor" : "")
        << secs;
    EXPECT_EQ(person.forces.joints[urdf::jLeftElbow].why_unknown, "") << secs;
  }
}

TEST_F(RecordedForcesTest, CsvAndMotOfTheSameForcesGiveTheSameLoads) {
  const testing::Scenes computed = ReadScenes("demo:lift", 1, {});
  std::string rows =
      "feet\nnRows=" + std::to_string(computed.size()) + "\nnColumns=19\nendheader\ntime";
  for (const char* side : {"r", "l"}) {
    for (const char* label :
         {"force_{}_vx", "force_{}_vy", "force_{}_vz", "force_{}_px", "force_{}_py", "force_{}_pz",
          "torque_{}_x", "torque_{}_y", "torque_{}_z"}) {
      rows += "\tground_" + fmt::format(fmt::runtime(label), side);
    }
  }
  rows += '\n';
  for (const auto& scene : computed) {
    rows += fmt::format("{}", Secs(scene->stamp_nanos - computed.front()->stamp_nanos));
    for (const FootForce& foot : scene->people[0].forces.feet) {
      rows +=
          fmt::format("\t{}\t{}\t{}\t{}\t{}\t{}\t0\t{}\t0", foot.force.x(), foot.force.z(),
                      -foot.force.y(), foot.cop.x(), foot.cop.z(), -foot.cop.y(), foot.free_moment);
    }
    rows += '\n';
  }
  const testing::Scenes of_csv = ReadScenes("demo:lift", 1, OptionsWith(FeetOf(computed)));
  const testing::Scenes of_mot = ReadScenes("demo:lift", 1, OptionsWith(rows, "forces.mot"));
  for (std::size_t i = 0; i < of_csv.size(); ++i) {
    EXPECT_TRUE(of_mot[i]->people[0].forces.ground_is_measured);
    EXPECT_LT(FarthestMoment(of_csv[i]->people[0], of_mot[i]->people[0]), 1e-9);
  }
}

TEST_F(RecordedForcesTest, TheTotalUnderBothFeetCountsAsWell) {
  const testing::Scenes computed = ReadScenes("demo:lift", 1, {});
  std::string rows = kHeader;
  for (const auto& scene : computed) {
    const PersonState& person = scene->people[0];
    const double secs = Secs(scene->stamp_nanos - computed.front()->stamp_nanos);
    rows += RowOf(secs, "Ground", person.forces.ground_force, *person.cop,
                  {0, 0, person.forces.ground_free_moment});
  }
  const testing::Scenes measured = ReadScenes("demo:lift", 1, OptionsWith(rows));
  for (std::size_t i = 0; i < measured.size(); ++i) {
    EXPECT_TRUE(measured[i]->people[0].forces.ground_is_measured);
    EXPECT_LT(FarthestMoment(measured[i]->people[0], computed[i]->people[0]), 0.01);
  }
}

TEST_F(RecordedForcesTest, AForceFarFromItsHandIsAnErrorWithItsTime) {
  const SceneOptions options = OptionsWith(std::string(kHeader) +
                                           "0,LeftHand,0,0,-50,9,0,1,0,0,0\n"
                                           "0.1,LeftHand,0,0,-50,9,0,1,0,0,0\n");
  try {
    ReadScenes("demo:n_pose", 0.1, options);
    FAIL() << "was accepted";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("forces.csv: at 0.000 s of the recording"),
                                    HasSubstr("m from the hand"), HasSubstr("--wrench_place")));
  }
}

TEST_F(RecordedForcesTest, TheForcesAreThoseOfTheFirstPersonOnly) {
  std::string rows = std::string(kHeader) + "0,LeftHand,0,0,-50,,,,0,0,0\n";
  const SceneOptions options = OptionsWith(rows);
  std::shared_ptr<const SceneState> last;
  SceneBuilder builder(options, "test", 60,
                       [&](std::shared_ptr<const SceneState> state) { last = std::move(state); });
  for (const int character : {7, 2}) {
    BodySample sample = subject::MakeMotion("n_pose")->At(0);
    sample.character = character;
    builder.OnSample(sample);
  }
  ASSERT_EQ(last->people.size(), 2U);
  for (const PersonState& person : last->people) {
    EXPECT_EQ(person.forces.hands[urdf::kLeft].is_measured, person.character == 7);
  }
}

}  // namespace
}  // namespace kinescope::app
