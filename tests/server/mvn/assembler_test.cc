#include "server/mvn/assembler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/server/mvn/assembler_fixture.h"

namespace kinescope::mvn {
namespace {

using testing::AssemblerTest;
using ::testing::ElementsAre;
using testing::kMilli;
using testing::kPeriod;
using testing::PoseItems;
using testing::RandomSample;
using testing::RawDatagram;

TEST_F(AssemblerTest, GivesASampleOnAsSoonAsAllUsualTypesHaveCome) {
  LearnFrom(1);
  const auto datagrams = Datagrams(7);
  for (std::size_t i = 0; i + 1 < datagrams.size(); ++i) {
    Send(datagrams[i]);
    EXPECT_TRUE(sink_.samples.empty()) << "after " << i + 1 << " of " << datagrams.size();
  }
  Wait(1000);
  Send(datagrams.back());
  ASSERT_EQ(sink_.samples.size(), 1U) << "without waiting for the next counter";
  EXPECT_EQ(sink_.samples[0].arrival_nanos, now_);
  ExpectAllAccountedFor();
  EXPECT_EQ(counters().samples, 7U);
  EXPECT_EQ(counters().incomplete, 0U);
}

TEST_F(AssemblerTest, HandsOnEveryNumberOfTheSample) {
  LearnFrom(1);
  const BodySample sent = RandomSample(random_, 7);
  Send(EncodeSample(sent));
  ASSERT_EQ(sink_.samples.size(), 1U);
  const BodySample& given = sink_.samples[0];
  EXPECT_EQ(given.counter, sent.counter);
  EXPECT_EQ(given.time_code_millis, sent.time_code_millis);
  EXPECT_TRUE(given.has_linear);
  EXPECT_TRUE(given.has_angular);
  for (std::size_t i = 0; i < given.segments.size(); ++i) {
    EXPECT_EQ(given.segments[i].position, sent.segments[i].position);
    EXPECT_LT(given.segments[i].orientation.angularDistance(sent.segments[i].orientation), 1e-6);
    EXPECT_EQ(given.segments[i].velocity, sent.segments[i].velocity);
    EXPECT_EQ(given.segments[i].acceleration, sent.segments[i].acceleration);
    EXPECT_EQ(given.segments[i].angular_velocity, sent.segments[i].angular_velocity);
    EXPECT_EQ(given.segments[i].angular_acceleration, sent.segments[i].angular_acceleration);
  }
  ASSERT_TRUE(given.com);
  EXPECT_EQ(given.com->acceleration, sent.com->acceleration);
  EXPECT_EQ(given.streamed_angles_deg, sent.streamed_angles_deg);
}

TEST_F(AssemblerTest, TakesTheTypesOfASampleInAnyOrder) {
  LearnFrom(1);
  for (std::uint32_t counter = 7; counter < 30; ++counter) {
    auto datagrams = Datagrams(counter);
    std::shuffle(datagrams.begin(), datagrams.end(), random_.engine());
    Send(datagrams);
    Wait(kPeriod);
  }
  EXPECT_EQ(sink_.samples.size(), 23U);
  EXPECT_EQ(counters().incomplete, 0U);
  EXPECT_EQ(counters().late, 0U);
}

TEST_F(AssemblerTest, WhenATypeIsLostTheNextCounterReleasesTheSample) {
  LearnFrom(1);
  auto datagrams = Datagrams(7);
  datagrams.pop_back();  // the centre of mass
  Send(datagrams);
  EXPECT_TRUE(sink_.samples.empty());
  Wait(kPeriod);
  Send(Datagrams(8)[0]);
  EXPECT_THAT(GivenCounters(), ElementsAre(7U));
  EXPECT_FALSE(sink_.samples[0].com);
  EXPECT_EQ(counters().incomplete, 1U);
}

TEST_F(AssemblerTest, WhenTheStreamFallsSilentATimeoutOfItsOwnPeriodReleasesTheSample) {
  LearnFrom(1);
  auto datagrams = Datagrams(7);
  datagrams.pop_back();
  Send(datagrams);
  const auto deadline = assembler_.deadline_nanos();
  ASSERT_TRUE(deadline);
  EXPECT_GT(*deadline - now_, kPeriod) << "the next sample normally comes first";
  EXPECT_LE(*deadline - now_, 2 * kPeriod);
  assembler_.Expire(*deadline - 1, sink_);
  EXPECT_TRUE(sink_.samples.empty());
  assembler_.Expire(*deadline, sink_);
  EXPECT_THAT(GivenCounters(), ElementsAre(7U));
  EXPECT_EQ(assembler_.deadline_nanos(), std::nullopt);
}

TEST_F(AssemblerTest, StopsWaitingForATypeThatIsSwitchedOff) {
  LearnFrom(1);
  int waited = 0;
  for (std::uint32_t counter = 7; counter < 30; ++counter) {
    auto datagrams = Datagrams(counter);
    datagrams.pop_back();
    const std::size_t before = sink_.samples.size();
    Send(datagrams);
    if (sink_.samples.empty() || sink_.samples.back().counter != counter) ++waited;
    EXPECT_LE(sink_.samples.size() - before, 2U);
    Wait(kPeriod);
  }
  EXPECT_EQ(waited, 5) << "five misses in a row mean that the type is off";
  EXPECT_EQ(counters().incomplete, 5U);
}

TEST_F(AssemblerTest, WaitsForATypeOnceItIsSwitchedOn) {
  for (std::uint32_t counter = 1; counter < 10; ++counter) {
    Send(Datagrams(counter)[0]);
    Wait(kPeriod);
  }
  sink_.samples.clear();
  Send(Datagrams(10));
  ASSERT_EQ(sink_.samples.size(), 1U) << "nobody could know of the others";
  EXPECT_FALSE(sink_.samples[0].com);
  Wait(kPeriod);
  Send(Datagrams(11));
  ASSERT_EQ(sink_.samples.size(), 2U);
  EXPECT_TRUE(sink_.samples[1].com);
  EXPECT_TRUE(sink_.samples[1].has_linear);
  EXPECT_EQ(counters().late, 4U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, NeedsAllTwentyThreeSegments) {
  RawDatagram raw;
  raw.items = 22;
  raw.payload = PoseItems(1, 22);
  for (raw.counter = 1; raw.counter < 6; ++raw.counter) Send(raw.Bytes());
  ExpectAllAccountedFor();
  EXPECT_TRUE(sink_.samples.empty());
  EXPECT_EQ(counters().rejected.at(Text(Reason::kNoWholePose)), 5U);
}

TEST_F(AssemblerTest, MakesThePoseOfLinearAndAngularKinematicsWhere02IsNotSent) {
  const BodySample sent = RandomSample(random_, 7);
  auto datagrams = EncodeSample(sent);
  datagrams.erase(datagrams.begin(), datagrams.begin() + 2);  // 02 and 20
  Send(datagrams);
  ExpectAllAccountedFor();
  ASSERT_EQ(sink_.samples.size(), 1U);
  for (std::size_t i = 0; i < sent.segments.size(); ++i) {
    const SegmentState& given = sink_.samples[0].segments[i];
    EXPECT_EQ(given.position, sent.segments[i].position);
    EXPECT_LT(given.orientation.angularDistance(sent.segments[i].orientation), 1e-6);
  }
}

TEST_F(AssemblerTest, JoinsAMessageThatCameInPartsInAnyOrder) {
  LearnFrom(1);
  RawDatagram first, second;
  first.counter = second.counter = 7;
  first.datagram_counter = 0x00;
  first.items = 12;
  first.payload = PoseItems(1, 12);
  second.datagram_counter = 0x81;
  second.items = 11;
  second.payload = PoseItems(13, 11);
  Send(second.Bytes());
  Send(second.Bytes());
  Send(first.Bytes());
  auto others = Datagrams(7);
  others.erase(others.begin());
  Send(others);
  ASSERT_EQ(sink_.samples.size(), 1U);
  EXPECT_EQ(sink_.samples[0].segments[urdf::kLeftToe].position, Eigen::Vector3d(0.5, 0.5, 0.5));
  EXPECT_EQ(counters().duplicates, 1U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, RefusesPartsThatContradictEachOther) {
  RawDatagram part;
  part.items = 1;
  part.payload = PoseItems(1, 1);
  part.datagram_counter = 0x81;
  Send(part.Bytes());
  part.datagram_counter = 0x02;  // after the last
  Send(part.Bytes());
  part.datagram_counter = 0x80;  // a second last
  Send(part.Bytes());
  EXPECT_EQ(counters().rejected.at(Text(Reason::kPartsContradict)), 2U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, CountsDuplicatesAndGivesTheSampleOnce) {
  LearnFrom(1);
  for (std::uint32_t counter = 7; counter < 12; ++counter) {
    const auto datagrams = Datagrams(counter);
    for (const std::string& datagram : datagrams) {
      Send(datagram);
      Send(datagram);
    }
    Send(datagrams);
    Wait(kPeriod);
  }
  EXPECT_THAT(GivenCounters(), ElementsAre(7U, 8U, 9U, 10U, 11U));
  EXPECT_EQ(counters().duplicates, 5U * 5 * 2);
  EXPECT_EQ(counters().late, 0U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, CountsADatagramOfAnOlderSampleAsLate) {
  LearnFrom(1);
  const auto held_up = Datagrams(7);
  Send(Datagrams(8));
  Send(held_up);
  EXPECT_THAT(GivenCounters(), ElementsAre(8U)) << "samples leave in order";
  EXPECT_EQ(counters().late, 5U);
  EXPECT_EQ(counters().restarts, 0U);
  Send(Datagrams(9));
  EXPECT_THAT(GivenCounters(), ElementsAre(8U, 9U));
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, ASteadyStrideIsNoGapAndALostSampleIsOne) {
  // 240 Hz captured, 60 Hz sent.
  for (std::uint32_t counter = 100; counter < 180; counter += 4) {
    if (counter != 148) Send(Datagrams(counter));
    Wait(4 * kPeriod);
  }
  EXPECT_EQ(counters().counter_gaps, 1U);
}

TEST_F(AssemblerTest, AStrideThatAlternatesIsNoGapEither) {
  std::uint32_t counter = 0;  // 240 Hz captured, 100 Hz sent: steps of 2 and 3
  for (int i = 0; i < 100; ++i) {
    counter = static_cast<std::uint32_t>(i * 240 / 100);
    Send(Datagrams(counter)[0]);
    Wait(10 * kMilli);
  }
  EXPECT_EQ(counters().counter_gaps, 0U);
  Send(Datagrams(counter + 5)[0]);
  EXPECT_EQ(counters().counter_gaps, 1U);
}

TEST_F(AssemblerTest, ACounterThatStartsOverIsARestart) {
  LearnFrom(5000);
  Send(Datagrams(0));
  Wait(kPeriod);
  Send(Datagrams(1));
  EXPECT_THAT(GivenCounters(), ElementsAre(0U, 1U));
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(counters().late, 0U);
}

TEST_F(AssemblerTest, ARestartSoonAfterTheStartIsToldFromLateDatagrams) {
  LearnFrom(1, 20);
  for (std::uint32_t counter = 0; counter < 15; ++counter) {
    Send(Datagrams(counter));
    Wait(kPeriod);
  }
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(GivenCounters().front(), 7U) << "eight samples in order, and no newer one among them";
  EXPECT_EQ(GivenCounters().back(), 14U);
}

TEST_F(AssemblerTest, AfterASilenceALowerCounterIsARestart) {
  LearnFrom(1, 20);
  Wait(300 * kMilli);
  Send(Datagrams(10));
  EXPECT_THAT(GivenCounters(), ElementsAre(10U));
  EXPECT_EQ(counters().restarts, 1U);
}

TEST_F(AssemblerTest, ACounterThatWrapsGoesOn) {
  for (std::uint32_t i = 0; i < 20; ++i) {
    Send(Datagrams(0xFFFFFFF6U + i));
    Wait(kPeriod);
  }
  ExpectAllAccountedFor();
  EXPECT_EQ(counters().samples, 20U);
  EXPECT_EQ(counters().restarts, 0U);
  EXPECT_EQ(counters().counter_gaps, 0U);
}

TEST_F(AssemblerTest, OneWildCounterDoesNotStopTheStream) {
  LearnFrom(1);
  Send(Datagrams(0x7000'0000)[0]);
  sink_.samples.clear();
  Send(Datagrams(7));
  Send(Datagrams(8));
  EXPECT_THAT(GivenCounters(), ::testing::Contains(7U));
  EXPECT_THAT(GivenCounters(), ::testing::Contains(8U));
}

// Loss, duplication, reordering, foreign text and restarts at once: whatever happens, every
// datagram ends in one place and no sample leaves twice or out of order.
TEST_F(AssemblerTest, AccountsForEveryDatagramOfABadNetwork) {
  std::vector<std::pair<std::int64_t, std::string>> in_flight;
  for (std::uint32_t i = 0; i < 600; ++i) {
    const std::uint32_t counter = i < 300 ? i + 5000 : i - 300;
    for (std::string& datagram : Datagrams(counter)) {
      if (random_.Coin(0.05)) continue;
      const std::int64_t sent = i * kPeriod;
      const auto delay = [&] { return random_.Coin(0.1) ? random_.Integer(0, 9) * kMilli : 0; };
      if (random_.Coin(0.05)) in_flight.emplace_back(sent + delay(), datagram);
      in_flight.emplace_back(sent + delay(), std::move(datagram));
    }
    if (random_.Coin(0.05)) in_flight.emplace_back(i * kPeriod, "{}");
  }
  std::stable_sort(in_flight.begin(), in_flight.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::int64_t start = now_;
  for (const auto& [time, datagram] : in_flight) {
    now_ = start + time;
    assembler_.Expire(now_, sink_);
    Send(datagram);
  }
  ExpectAllAccountedFor();
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_GT(counters().samples, 500U);
  EXPECT_GT(counters().duplicates, 0U);
  EXPECT_GT(counters().late, 0U);
  EXPECT_EQ(counters().samples, sink_.samples.size());
  int lower = 0;
  for (std::size_t i = 1; i < sink_.samples.size(); ++i) {
    EXPECT_NE(sink_.samples[i].counter, sink_.samples[i - 1].counter);
    EXPECT_GT(sink_.samples[i].stamp_nanos, sink_.samples[i - 1].stamp_nanos);
    if (sink_.samples[i].counter < sink_.samples[i - 1].counter) ++lower;
  }
  EXPECT_EQ(lower, 1) << "only at the restart";
}

}  // namespace
}  // namespace kinescope::mvn
