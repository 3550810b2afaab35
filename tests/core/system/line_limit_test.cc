#include "core/system/line_limit.h"

#include <gtest/gtest.h>

namespace kinescope {
namespace {

TEST(LineLimit, PassesOneLineASecondAndCountsTheOthers) {
  LineLimit limit;
  EXPECT_EQ(limit.Pass("a", kNanosPerSecond), "a");
  EXPECT_EQ(limit.Pass("b", kNanosPerSecond + 1), "");
  EXPECT_EQ(limit.Pass("c", 2 * kNanosPerSecond - 1), "");
  EXPECT_EQ(limit.Pass("d", 2 * kNanosPerSecond), "d (and 2 more)");
  EXPECT_EQ(limit.Pass("e", 3 * kNanosPerSecond), "e");
}

}  // namespace
}  // namespace kinescope
