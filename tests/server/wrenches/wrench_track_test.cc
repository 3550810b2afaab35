#include "server/wrenches/wrench_track.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "core/system/errors.h"
#include "tests/server/wrenches/wrenches_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::wrenches {
namespace {

using Eigen::Vector3d;
using kinescope::testing::TempFolder;
using ::testing::HasSubstr;
using testing::kHeader;
using testing::WriteText;

constexpr double kSample = 1.0 / 60;  // s

/// A track from the rows of a CSV.
class Tracked {
 public:
  explicit Tracked(const std::string& rows) : track(FileOf(rows)) {}

  double HandForceAt(double secs, double period = kSample) {
    const auto found = track.MeanAt(secs, period)[At(WrenchBody::kLeftHand)];
    return found ? found->force.x() : std::nan("");
  }

  TempFolder folder;
  WrenchTrack track;

 private:
  WrenchSettings FileOf(const std::string& rows) const {
    WrenchSettings settings;
    settings.path = folder / "forces.csv";
    WriteText(settings.path, kHeader + rows);
    return settings;
  }
};

std::string HandRow(double secs, double force) {
  return fmt::format("{},LeftHand,{},0,0,,,,0,0,0\n", secs, force);
}

template <class Value>
std::string HandRows(int count, double step, Value&& value) {
  std::string rows;
  for (int i = 0; i < count; ++i) rows += HandRow(i * step, value(i * step));
  return rows;
}

std::string ErrorOfFile(const std::string& rows) {
  try {
    const Tracked tracked(rows);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WrenchTrack, InterpolatesRowsThatAreAsRareAsSamples) {
  Tracked tracked(HandRow(0, 10) + HandRow(0.05, 20));
  EXPECT_DOUBLE_EQ(tracked.HandForceAt(0), 10);
  EXPECT_DOUBLE_EQ(tracked.HandForceAt(0.0125), 12.5);
  EXPECT_DOUBLE_EQ(tracked.HandForceAt(0.05), 20);
}

TEST(WrenchTrack, GivesTheValuesOfRowsAtTheTimesOfSamplesUnchanged) {
  const auto value = [](double secs) { return 100 * std::sin(40 * secs); };
  Tracked tracked(HandRows(60, kSample, value));
  for (int i = 0; i < 60; ++i)
    EXPECT_NEAR(tracked.HandForceAt(i * kSample), value(i * kSample), 1e-3);
}

// 60 Hz of the suit would see the 120 Hz of the plate as a constant force.
TEST(WrenchTrack, AveragesAVibrationThatSamplesWouldAlias) {
  Tracked tracked(
      HandRows(1000, 0.001, [](double secs) { return 50 + 30 * std::cos(2 * M_PI * 120 * secs); }));
  for (int i = 6; i < 50; ++i) EXPECT_NEAR(tracked.HandForceAt(i * kSample), 50, 2) << i;
}

TEST(WrenchTrack, FollowsALineExactlyWhateverItsRate) {
  for (const double step : {0.0005, 0.001, 0.0041, 0.0166, 0.09}) {
    Tracked tracked(
        HandRows(static_cast<int>(1 / step) + 2, step, [](double secs) { return 7 * secs; }));
    for (int i = 1; i < 59; ++i) {
      EXPECT_NEAR(tracked.HandForceAt(i * kSample), 7 * i * kSample, 1e-4) << step;
    }
  }
}

TEST(WrenchTrack, HasNoValuesOutsideTheFileAndInGaps) {
  Tracked tracked(HandRow(1, 5) + HandRow(1.1, 5) + HandRow(1.3, 9) + HandRow(1.35, 9));
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(0.99)));
  EXPECT_EQ(tracked.HandForceAt(1), 5);
  EXPECT_EQ(tracked.HandForceAt(1.05), 5);
  EXPECT_EQ(tracked.HandForceAt(1.1), 5);
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(1.11)));
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(1.29)));
  EXPECT_EQ(tracked.HandForceAt(1.3), 9);
  EXPECT_EQ(tracked.HandForceAt(1.35), 9);
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(1.36)));
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(100)));
}

TEST(WrenchTrack, NeverAveragesAcrossAGap) {
  std::string rows;
  for (int i = 0; i < 100; ++i) rows += HandRow(i * 0.001, 10);
  for (int i = 0; i < 100; ++i) rows += HandRow(0.5 + i * 0.001, 90);
  Tracked tracked(rows);
  EXPECT_DOUBLE_EQ(tracked.HandForceAt(0.099), 10);
  EXPECT_TRUE(std::isnan(tracked.HandForceAt(0.3)));
  EXPECT_DOUBLE_EQ(tracked.HandForceAt(0.5), 90);
}

TEST(WrenchTrack, GivesTheSameAfterAStepBackInTime) {
  Tracked tracked(HandRows(100, 0.01, [](double secs) { return secs; }));
  const double first = tracked.HandForceAt(0.2);
  tracked.HandForceAt(0.9);
  EXPECT_EQ(tracked.HandForceAt(0.2), first);
}

// Two rows with different forces at different points: their mean is a mean of wrenches, in which
// the larger force has the larger part of the centre of pressure.
TEST(WrenchTrack, AveragesTheWrenchAndNotThePoint) {
  Tracked tracked(
      "0,Ground,0,0,300,0,0,0,0,0,0\n"
      "0.1,Ground,0,0,100,0.4,0,0,0,0,0\n");
  const auto found = tracked.track.MeanAt(0.05, kSample)[At(WrenchBody::kGround)];
  ASSERT_TRUE(found);
  const MeasuredGroundForce ground = GroundForceOf(*found, 0, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(ground.force.z(), 200);
  EXPECT_DOUBLE_EQ(ground.point.x(), 0.1);
}

TEST(WrenchTrack, MovesTheForceAlongItsLineToTheFloor) {
  // On a plate 0.2 m above the floor: F = (50, -30, 500) N at (1, 2, 0.2), with T = (10, 20, 3).
  BodyWrench wrench;
  const Vector3d point(1, 2, 0.2), torque(10, 20, 3);
  wrench.force = {50, -30, 500};
  wrench.moment = torque + point.cross(wrench.force);
  const MeasuredGroundForce ground = GroundForceOf(wrench, 0, Vector3d::Zero());
  EXPECT_EQ(ground.force, wrench.force);
  EXPECT_FALSE(ground.only_vertical);
  const Vector3d moment = ground.point.cross(ground.force) + ground.free_moment * Vector3d::UnitZ();
  EXPECT_TRUE(moment.isApprox(wrench.moment, 1e-12)) << "the same wrench";
  EXPECT_EQ(ground.point.z(), 0);
  EXPECT_NEAR(ground.point.x(), 1 - 0.2 * 50 / 500 - 20.0 / 500, 1e-12);
}

TEST(WrenchTrack, TakesTheNoiseOfAnEmptyPlateForNoForceAtTheLastPoint) {
  BodyWrench wrench;
  wrench.force = {5, 0, 19};
  wrench.moment = {100, 100, 100};
  const MeasuredGroundForce ground = GroundForceOf(wrench, 0, {1, 2, 0});
  EXPECT_EQ(ground.force, Vector3d::Zero());
  EXPECT_EQ(ground.point, Vector3d(1, 2, 0));
  EXPECT_EQ(ground.free_moment, 0);
}

TEST(WrenchTrack, GivesAHandItsMomentAboutThePointOfTheForce) {
  Tracked tracked("0,RightHand,1,2,3,0.5,0.6,0.7,4,5,6\n0.05,RightHand,1,2,3,0.5,0.6,0.7,4,5,6\n");
  const auto found = tracked.track.MeanAt(0.02, kSample)[At(WrenchBody::kRightHand)];
  ASSERT_TRUE(found);
  const MeasuredHandForce hand = HandForceOf(*found);
  EXPECT_TRUE(hand.force.isApprox(Vector3d(1, 2, 3)));
  EXPECT_TRUE(hand.point->isApprox(Vector3d(0.5, 0.6, 0.7)));
  EXPECT_TRUE(hand.moment.isApprox(Vector3d(4, 5, 6)));
}

TEST(WrenchTrack, RefusesFilesThatLackABody) {
  EXPECT_THAT(ErrorOfFile(""), HasSubstr("contains no row of forces"));
  EXPECT_THAT(ErrorOfFile("0,RightFoot,0,0,700,0,0,0,0,0,0\n"),
              HasSubstr("has forces on RightFoot only; expected those on both feet"));
  EXPECT_THAT(ErrorOfFile("0,LeftHand,1,0,0,,,,0,0,0\n1,LeftHand,1,0,0,1,1,1,0,0,0\n"),
              HasSubstr("rows of LeftHand have a point only in part"));
  EXPECT_EQ(ErrorOfFile("0,LeftHand,0,0,0,,,,0,0,0\n1,LeftHand,1,0,0,1,1,1,0,0,0\n"), "accepted");
}

TEST(WrenchTrack, ReportsAnErrorInTheLastLineBeforeAnythingIsComputed) {
  EXPECT_THAT(ErrorOfFile(HandRows(5000, 0.001, [](double) { return 1; }) + "5,LeftHand,1,0"),
              HasSubstr("forces.csv: line 5002: 4 cells"));
}

TEST(WrenchTrack, LimitsTheRowsThatItKeeps) {
  Tracked tracked(HandRows(120'000, 1e-6, [](double) { return 1; }));
  EXPECT_THROW(tracked.HandForceAt(0), SourceError);
}

TEST(WrenchTrack, RefusesWhatIsNoFile) {
  const TempFolder folder;
  const auto error = [](const std::string& path) -> std::string {
    WrenchSettings settings;
    settings.path = path;
    try {
      const WrenchTrack track(settings);
    } catch (const SourceError& refused) {
      return refused.what();
    }
    return "accepted";
  };
  EXPECT_THAT(error(folder / "none.csv"), HasSubstr("none.csv: cannot open the file"));
  mkdir((folder / "folder.csv").c_str(), 0700);
  EXPECT_THAT(error(folder / "folder.csv"), HasSubstr("folder.csv: is a folder"));
  mkfifo((folder / "pipe.csv").c_str(), 0600);
  EXPECT_THAT(error(folder / "pipe.csv"), HasSubstr("pipe.csv: is a pipe or a device"));
}

}  // namespace
}  // namespace kinescope::wrenches
