#include "server/loads/floor_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinescope::loads {
namespace {

constexpr double kFloorRateHz = 100;

// Both feet at rest at their heights, or on the way.
class Walker {
 public:
  void Stand(double right, double left, double secs) { Add(right, left, 0.01, secs); }
  void Fly(double height, double secs) { Add(height, height, 2, secs); }
  double height() const { return finder_.height(); }
  bool is_found() const { return finder_.is_found(); }

 private:
  void Add(double right, double left, double speed, double secs) {
    std::normal_distribution<double> noise(0, 0.001);
    for (int i = 0; i < secs * kFloorRateHz; ++i) {
      const double stamp = static_cast<double>(count_++) / kFloorRateHz;
      finder_.Add(std::llround(1e9 * stamp), {right + noise(random_), left + noise(random_)},
                  {speed, speed});
    }
  }

  FloorFinder finder_;
  std::mt19937 random_{1};
  long count_ = 0;
};

TEST(FloorFinder, FindsTheLevelOnWhichTheFeetRestWhereverItIs) {
  for (const double floor : {-0.30, -0.06, 0.06, 0.9, 12.0}) {
    Walker walker;
    for (int step = 0; step < 5; ++step) {
      walker.Stand(floor, floor, 0.6);
      walker.Fly(floor + 0.2, 0.3);
    }
    EXPECT_NEAR(walker.height(), floor, 0.003);
  }
}

TEST(FloorFinder, TakesALevelCloseToZeroForTheFloorOfMvn) {
  Walker walker;
  walker.Stand(0.003, 0.003, 2);
  EXPECT_EQ(walker.height(), 0);
}

TEST(FloorFinder, StartsWithTheLowestPointAndCorrectsItWhenAFootRests) {
  Walker walker;
  walker.Fly(0.5, 0.2);  // begins with a jump
  EXPECT_NEAR(walker.height(), 0.5, 0.005);
  walker.Stand(0.06, 0.06, 1);
  EXPECT_NEAR(walker.height(), 0.06, 0.003);
}

TEST(FloorFinder, HasFoundAFloorOnlyWhenAFootHasRested) {
  Walker walker;
  walker.Fly(0.5, 3);
  walker.Stand(0, 0, 0.25);
  EXPECT_FALSE(walker.is_found());
  walker.Stand(0, 0, 0.5);
  EXPECT_TRUE(walker.is_found());
  walker.Fly(0.5, 3);
  EXPECT_TRUE(walker.is_found());
}

TEST(FloorFinder, KeepsTheLowestOfSeveralLevels) {
  Walker walker;
  walker.Stand(0, 0, 3);
  walker.Stand(0.2, 0, 3);     // one foot on a step
  walker.Stand(0.4, 0.4, 30);  // on the platform
  EXPECT_EQ(walker.height(), 0);
}

TEST(FloorFinder, IgnoresAShortDip) {
  Walker walker;
  walker.Stand(0, 0, 20);
  walker.Stand(-0.05, -0.05, 0.4);  // drift that was corrected
  walker.Stand(0, 0, 1);
  EXPECT_EQ(walker.height(), 0);
}

}  // namespace
}  // namespace kinescope::loads
