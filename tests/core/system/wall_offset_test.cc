#include "core/system/wall_offset.h"

#include <gtest/gtest.h>

namespace kinescope {
namespace {

constexpr std::int64_t kWall = 1'700'000'000 * kNanosPerSecond;

TEST(WallOffset, TellsByHowMuchTheClockWasSetAndFollowsWhatIsGradual) {
  WallOffset offset(kWall, 0);
  EXPECT_EQ(offset.Read(kWall + kNanosPerSecond, kNanosPerSecond), 0);
  EXPECT_EQ(offset.nanos(), kWall);
  for (int i = 1; i <= 10; ++i) EXPECT_EQ(offset.Read(kWall + i * 10 * kNanosPerMilli, 0), 0);
  EXPECT_EQ(offset.nanos(), kWall + 100 * kNanosPerMilli);
  EXPECT_EQ(offset.Read(kWall - 4900 * kNanosPerMilli, 0), -5 * kNanosPerSecond);
  EXPECT_EQ(offset.Read(kWall - 4900 * kNanosPerMilli, 0), 0) << "once";
  EXPECT_EQ(offset.nanos(), kWall - 4900 * kNanosPerMilli);
}

}  // namespace
}  // namespace kinescope
