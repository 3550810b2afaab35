#include "server/app/serve/overload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "core/scene_state.h"
#include "core/system/clocks.h"
#include "tests/captured_log.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kBehind = 3700 * kNanosPerMilli;

TEST(Overload, KnowsHowLongASampleWaited) {
  BodySample sample;
  sample.arrival_nanos = 5000 * kNanosPerMilli;
  EXPECT_EQ(Overload::WaitedNanos(sample, 8700 * kNanosPerMilli), kBehind);
  EXPECT_EQ(Overload::WaitedNanos(sample, 4999 * kNanosPerMilli), 0);
  sample.arrival_nanos = 0;
  EXPECT_EQ(Overload::WaitedNanos(sample, 8700 * kNanosPerMilli), 0) << "of a file";
}

// Of 240 samples that come at once, how many are processed.
int Admitted(Overload& overload, std::int64_t waited) {
  int admitted = 0;
  for (int i = 0; i < 240; ++i) {
    admitted += overload.Admit(0, waited, 9000 * kNanosPerMilli + i * kNanosPerMilli) ? 1 : 0;
  }
  return admitted;
}

TEST(Overload, SkipsOldSamplesButNeverAllOfThem) {
  const testing::CapturedLog log;
  Overload overload(/*may_skip=*/true);
  EXPECT_EQ(Admitted(overload, kBehind), 5) << "one every 50 ms";
  EXPECT_EQ(overload.skipped(), 235U);
  EXPECT_THAT(log.text(), HasSubstr("behind by 3.7 s"));
  EXPECT_EQ(Admitted(overload, kOverloadNanos), 240);
  EXPECT_THAT(log.text(), HasSubstr("up to date again; 235 samples were not shown"));
}

TEST(Overload, ShowsEverybodyWhileItSkips) {
  const testing::CapturedLog log;
  Overload overload(/*may_skip=*/true);
  std::map<int, int> admitted;
  for (int i = 0; i < 480; ++i) {
    const int character = i % 2;
    if (overload.Admit(character, kBehind, 9000 * kNanosPerMilli + i * kNanosPerMilli))
      ++admitted[character];
  }
  EXPECT_EQ(admitted[0], 10);
  EXPECT_EQ(admitted[1], 10);
}

TEST(Overload, SkipsNothingWhereEverySampleCounts) {
  const testing::CapturedLog log;
  Overload overload(/*may_skip=*/false);
  EXPECT_EQ(Admitted(overload, kBehind), 240);
  EXPECT_EQ(overload.skipped(), 0U);
  EXPECT_THAT(log.text(), HasSubstr("every sample is still published to ROS"));
}

TEST(Overload, DoesNotFillTheLogOfAMachineAtItsLimit) {
  const testing::CapturedLog log;
  Overload overload(/*may_skip=*/true);
  for (int i = 0; i < 2000; ++i) {
    (void)overload.Admit(0, i % 2 == 0 ? kBehind : 0, 9000 * kNanosPerMilli + i * kNanosPerMilli);
  }
  const std::string text = log.text();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
}

}  // namespace
}  // namespace kinescope::app
