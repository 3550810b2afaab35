#include "server/source/counter_splice.h"

#include <gmock/gmock.h>

#include <vector>

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;

std::vector<std::uint32_t> Rounds(const std::vector<std::uint32_t>& values, int rounds) {
  CounterSplice splice;
  std::vector<std::uint32_t> continued;
  for (int round = 0; round < rounds; ++round) {
    splice.BeginRound();
    for (const std::uint32_t value : values) continued.push_back(splice.Add(value));
  }
  return continued;
}

TEST(CounterSplice, StartsEveryRoundOneStepAfterThePreviousOne) {
  EXPECT_THAT(Rounds({7, 8, 9}, 3), ElementsAre(7, 8, 9, 10, 11, 12, 13, 14, 15));
  EXPECT_THAT(Rounds({16, 20, 24}, 2), ElementsAre(16, 20, 24, 28, 32, 36));
}

TEST(CounterSplice, DoesNotUseAGapAsStep) {
  EXPECT_THAT(Rounds({1, 2, 9}, 2), ElementsAre(1, 2, 9, 10, 11, 18));
}

TEST(CounterSplice, DoesNotUseARestartOfTheSenderAsStep) {
  EXPECT_THAT(Rounds({1000, 1001, 5}, 2), ElementsAre(1000, 1001, 5, 6, 7, 0xFFFF'FC23));
}

TEST(CounterSplice, IncreasesASingleValueByOne) {
  EXPECT_THAT(Rounds({90}, 3), ElementsAre(90, 91, 92));
}

TEST(CounterSplice, WrapsAround) {
  EXPECT_THAT(Rounds({0xFFFF'FFFE, 0xFFFF'FFFF}, 2), ElementsAre(0xFFFF'FFFE, 0xFFFF'FFFF, 0, 1));
}

TEST(CounterSplice, ContinuesALateValueOfTheRoundWithoutAddingIt) {
  CounterSplice splice;
  splice.Add(1);
  splice.Add(2);
  splice.BeginRound();
  splice.Add(1);
  splice.Add(2);
  EXPECT_EQ(splice.Continued(1), 3U);
  EXPECT_EQ(splice.Add(3), 5U);
}

}  // namespace
}  // namespace kinescope::app
