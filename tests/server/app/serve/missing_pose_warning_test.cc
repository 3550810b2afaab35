#include "server/app/serve/missing_pose_warning.h"

#include <gtest/gtest.h>

#include "core/system/clocks.h"
#include "server/app/serve/crowd_warning.h"
#include "tests/captured_log.h"

namespace kinescope::app {
namespace {

SourceCounters DatagramsWithoutPose() {
  SourceCounters counters;
  counters.datagrams = 240;
  counters.rejected = {{"cut short", 3}, {"no MXTP id string", 200}, {"wrong size", 7}};
  return counters;
}

TEST(MissingPoseWarning, ReportsTheMostFrequentReasonOnceAfterTwoSeconds) {
  const testing::CapturedLog log;
  MissingPoseWarning warning;
  warning.OnCounters(DatagramsWithoutPose(), "udp://:9763", 0);
  warning.OnCounters(DatagramsWithoutPose(), "udp://:9763", 2 * kNanosPerSecond - 1);
  EXPECT_EQ(log.text(), "");
  for (int i = 2; i < 5; ++i) {
    warning.OnCounters(DatagramsWithoutPose(), "udp://:9763", i * kNanosPerSecond);
  }
  EXPECT_EQ(log.text(),
            "warning: 240 datagrams from udp://:9763, but no complete pose: no MXTP id string. For "
            "details run `kinescope inspect udp://:9763`\n");
}

TEST(MissingPoseWarning, SpeaksOfMessagesOfAGraph) {
  const testing::CapturedLog log;
  MissingPoseWarning warning;
  for (int i = 0; i < 3; ++i) {
    warning.OnCounters(DatagramsWithoutPose(), "ros:/tf", i * kNanosPerSecond);
  }
  EXPECT_EQ(log.text(),
            "warning: 240 messages from ros:/tf, but no person among their frames; expected 23 "
            "segments, such as skeleton_pelvis. For details run `kinescope inspect ros:/tf`\n");
}

TEST(CrowdWarning, NamesTheLimitOnce) {
  const testing::CapturedLog log;
  CrowdWarning warning;
  warning.OnCounters(DatagramsWithoutPose());
  EXPECT_EQ(log.text(), "");
  SourceCounters counters;
  counters.rejected = {{"too many senders or characters", 40}};
  for (int i = 0; i < 3; ++i) warning.OnCounters(counters);
  EXPECT_EQ(log.text(),
            "warning: all 16 places for people are taken; 40 datagrams of further senders were "
            "rejected so far. --from ADDRESS admits only some senders\n");
}

TEST(MissingPoseWarning, CountsTheTimeFromTheFirstDatagrams) {
  const testing::CapturedLog log;
  MissingPoseWarning warning;
  warning.OnCounters(SourceCounters(), "udp://:9763", 0);
  warning.OnCounters(DatagramsWithoutPose(), "udp://:9763", 10 * kNanosPerSecond);
  EXPECT_EQ(log.text(), "") << "a suit that was switched on now";
}

TEST(MissingPoseWarning, IsAbsentWhileARecordingIsPassedOver) {
  const testing::CapturedLog log;
  MissingPoseWarning warning;
  SourceCounters counters = DatagramsWithoutPose();
  counters.passed_nanos = 1;
  for (int i = 0; i < 5; ++i) warning.OnCounters(counters, "take.bag", i * kNanosPerSecond);
  EXPECT_EQ(log.text(), "");
}

TEST(MissingPoseWarning, IsAbsentWhileThereAreSamplesOrNoDatagrams) {
  const testing::CapturedLog log;
  MissingPoseWarning warning;
  SourceCounters fine = DatagramsWithoutPose();
  fine.samples = 1;
  for (int i = 0; i < 5; ++i) {
    warning.OnCounters(SourceCounters(), "udp://:9763", i * kNanosPerSecond);
    warning.OnCounters(fine, "udp://:9763", i * kNanosPerSecond);
  }
  EXPECT_EQ(log.text(), "");
}

}  // namespace
}  // namespace kinescope::app
