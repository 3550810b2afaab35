#include "server/app/render/moments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;

// 10 pictures per second from `start_millis` on.
TimeGrid TenPerSecond(std::int64_t start_millis, std::optional<std::int64_t> length_millis) {
  TimeGrid grid;
  grid.rate = {10, 1};
  grid.start_nanos = start_millis * kNanosPerMilli;
  if (length_millis) grid.length_nanos = *length_millis * kNanosPerMilli;
  return grid;
}

// "0 at 200": picture 0 at 200 ms.
std::string MomentText(const Moment& moment) {
  return (moment.picture ? std::to_string(*moment.picture) : "still") + " at " +
         std::to_string(moment.nanos / kNanosPerMilli);
}

std::vector<std::string> AllMoments(Moments moments) {
  std::vector<std::string> all;
  while (const auto moment = moments.Next()) all.push_back(MomentText(*moment));
  return all;
}

TEST(Moments, PutAStillBetweenTheFramesOfAClip) {
  EXPECT_THAT(AllMoments({250 * kNanosPerMilli, TenPerSecond(200, 200)}),
              ElementsAre("0 at 200", "still at 250", "1 at 300"));
}

TEST(Moments, PutAStillBeforeOrAfterAClip) {
  EXPECT_THAT(AllMoments({0, TenPerSecond(100, 100)}), ElementsAre("still at 0", "0 at 100"));
  EXPECT_THAT(AllMoments({900 * kNanosPerMilli, TenPerSecond(0, 200)}),
              ElementsAre("0 at 0", "1 at 100", "still at 900"));
}

TEST(Moments, PutAStillBeforeAFrameOfTheSameTime) {
  EXPECT_THAT(AllMoments({100 * kNanosPerMilli, TenPerSecond(0, 200)}),
              ElementsAre("0 at 0", "still at 100", "1 at 100"));
}

TEST(Moments, ConsistOfAStillOrAClipAlone) {
  EXPECT_THAT(AllMoments({std::nullopt, TenPerSecond(0, 100)}), ElementsAre("0 at 0"));
  EXPECT_THAT(AllMoments({5 * kNanosPerMilli, std::nullopt}), ElementsAre("still at 5"));
  EXPECT_THAT(AllMoments({std::nullopt, std::nullopt}), ElementsAre());
}

TEST(Moments, KeepTheStillIfTheClipEndsWithItsSource) {
  Moments moments(800 * kNanosPerMilli, TenPerSecond(0, std::nullopt));
  EXPECT_EQ(MomentText(moments.Next().value()), "0 at 0");
  EXPECT_EQ(MomentText(moments.Next().value()), "1 at 100");
  moments.EndClip();
  EXPECT_EQ(MomentText(moments.Next().value()), "still at 800");
  EXPECT_FALSE(moments.Next());
}

}  // namespace
}  // namespace kinescope::app
