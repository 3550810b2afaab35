#include "server/mvn/assembler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/server/mvn/assembler_fixture.h"

namespace kinescope::mvn {
namespace {

using testing::AssemblerTest;
using ::testing::ElementsAre;
using testing::kPeriod;
using testing::PoseItems;
using testing::RandomSample;
using testing::RawDatagram;

TEST_F(AssemblerTest, DeliversASampleWhenAllUsualTypesHaveArrived) {
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

TEST_F(AssemblerTest, DeliversEveryValueOfTheSample) {
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

TEST_F(AssemblerTest, AcceptsTheTypesOfASampleInAnyOrder) {
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

TEST_F(AssemblerTest, DeliversASampleWithALostTypeWhenTheNextOneIsComplete) {
  LearnFrom(1);
  auto datagrams = Datagrams(7);
  datagrams.pop_back();  // the centre of mass
  Send(datagrams);
  EXPECT_TRUE(sink_.samples.empty());
  Wait(kPeriod);
  const auto next = Datagrams(8);
  Send(std::vector<std::string>(next.begin(), next.begin() + 3));
  EXPECT_TRUE(sink_.samples.empty()) << "a datagram may be a few places late";
  Send(next[3]);
  EXPECT_THAT(GivenCounters(), ElementsAre(7U)) << "the next one has all that this one has";
  EXPECT_FALSE(sink_.samples[0].com);
  EXPECT_EQ(counters().incomplete, 1U);
}

TEST_F(AssemblerTest, DeliversTheLastSampleAfterATimeoutOfAboutOnePeriod) {
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

TEST_F(AssemblerTest, WaitsForATypeAfterItIsSwitchedOn) {
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

TEST_F(AssemblerTest, BuildsThePoseFromLinearAndAngularKinematicsWithoutType02) {
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

TEST_F(AssemblerTest, JoinsTheDatagramsOfAMessageInAnyOrder) {
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

TEST_F(AssemblerTest, RejectsContradictoryPartsOfAMessage) {
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

TEST_F(AssemblerTest, CountsDuplicatesAndDeliversTheSampleOnce) {
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

// A sender that pauses within a sample: a robot cannot wait for it, a file can.
TEST_F(AssemblerTest, WaitsForTheRestOfASampleAsTheDeliverySays) {
  for (const Delivery delivery : {Delivery::kPrompt, Delivery::kComplete}) {
    Assembler assembler({Stamps::kFitted, delivery});
    testing::RecordingSink sink;
    for (std::uint32_t counter = 1; counter <= 20; ++counter) {
      const auto datagrams = Datagrams(counter);
      for (const std::string& datagram : datagrams) {
        const bool is_lost = counter == 15 && &datagram == &datagrams[2];
        if (!is_lost) assembler.Add(sender_, datagram, now(), sink);
        if (counter == 10 && &datagram == &datagrams[1]) Wait(300 * kNanosPerMilli);
        assembler.Expire(now_, sink);
      }
      Wait(kPeriod);
    }
    const bool is_complete = delivery == Delivery::kComplete;
    EXPECT_EQ(assembler.counters().late, is_complete ? 0U : 3U);
    EXPECT_EQ(assembler.counters().incomplete, is_complete ? 1U : 2U);
    EXPECT_EQ(sink.samples.size(), 20U) << "a lost datagram holds up two samples at most";
  }
}

TEST_F(AssemblerTest, CountsALostSampleButNoConstantCounterStepAsGap) {
  // 240 Hz captured, 60 Hz sent.
  for (std::uint32_t counter = 100; counter < 180; counter += 4) {
    if (counter != 148) Send(Datagrams(counter));
    Wait(4 * kPeriod);
  }
  EXPECT_EQ(counters().counter_gaps, 1U);
}

TEST_F(AssemblerTest, CountsHowManySamplesAreLost) {
  for (std::uint32_t counter = 100; counter < 600; counter += 4) {  // 240 Hz captured, 60 Hz sent
    const bool is_lost = counter == 400 || (counter >= 500 && counter < 520);
    if (!is_lost) Send(Datagrams(counter));
    Wait(4 * kPeriod);
  }
  EXPECT_EQ(counters().lost, 6U);
  EXPECT_EQ(counters().counter_gaps, 2U);
}

TEST_F(AssemblerTest, MeasuresByHowMuchSamplesComeLate) {
  for (std::uint32_t counter = 4; counter <= 2000; counter += 4) {
    const std::int64_t late = counter % 20 == 0 ? 8 * kNanosPerMilli : 0;
    Wait(late);
    Send(Datagrams(counter));
    Wait(4 * kPeriod - late);
  }
  const DurationHistogram delays = counters().delays;
  EXPECT_GE(delays.total(), 499U);
  EXPECT_LT(delays.PercentileNanos(0.7), 1 * kNanosPerMilli);
  EXPECT_NEAR(static_cast<double>(delays.PercentileNanos(0.95)), 8e6, 1e6);
}

TEST_F(AssemblerTest, CountsNoAlternatingCounterStepAsGap) {
  std::uint32_t counter = 0;  // 240 Hz captured, 100 Hz sent: steps of 2 and 3
  for (int i = 0; i < 100; ++i) {
    counter = static_cast<std::uint32_t>(i * 240 / 100);
    Send(Datagrams(counter)[0]);
    Wait(10 * kNanosPerMilli);
  }
  EXPECT_EQ(counters().counter_gaps, 0U);
  Send(Datagrams(counter + 5)[0]);
  EXPECT_EQ(counters().counter_gaps, 1U);
}

TEST_F(AssemblerTest, DetectsARestartWhenTheCounterStartsAgain) {
  LearnFrom(5000);
  Send(Datagrams(0));
  Wait(kPeriod);
  Send(Datagrams(1));
  EXPECT_THAT(GivenCounters(), ElementsAre(0U, 1U));
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(counters().late, 0U);
}

TEST_F(AssemblerTest, DistinguishesAnEarlyRestartFromLateDatagrams) {
  LearnFrom(1, 20);
  for (std::uint32_t counter = 0; counter < 15; ++counter) {
    Send(Datagrams(counter));
    Wait(kPeriod);
  }
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_EQ(GivenCounters().front(), 0U);
  EXPECT_EQ(counters().late + counters().duplicates + counters().outliers, 0U);
  EXPECT_EQ(GivenCounters().back(), 14U);
}

TEST_F(AssemblerTest, DetectsARestartByALowerCounterAfterAGap) {
  LearnFrom(1, 20);
  Wait(300 * kNanosPerMilli);
  Send(Datagrams(10));
  EXPECT_THAT(GivenCounters(), ElementsAre(10U));
  EXPECT_EQ(counters().restarts, 1U);
}

TEST_F(AssemblerTest, ContinuesWhenTheCounterWraps) {
  for (std::uint32_t i = 0; i < 20; ++i) {
    BodySample sample = RandomSample(random_, 0xFFFFFFF6U + i);
    sample.time_code_millis = 0xFFFFFFF0U + i * 1000 / 240;
    Send(EncodeSample(sample));
    Wait(kPeriod);
  }
  ExpectAllAccountedFor();
  EXPECT_EQ(counters().samples, 20U);
  EXPECT_EQ(counters().restarts, 0U);
  EXPECT_EQ(counters().counter_gaps, 0U);
}

TEST_F(AssemblerTest, AcceptsADatagramThatOvertookThreeOthers) {
  LearnFrom(1);
  std::vector<std::string> sent;
  for (std::uint32_t counter = 7; counter < 40; ++counter) {
    for (std::string& datagram : Datagrams(counter)) sent.push_back(std::move(datagram));
  }
  for (std::size_t i = 0; i + 3 < sent.size(); i += 7)
    std::rotate(&sent[i], &sent[i + 1], &sent[i + 4]);
  Send(sent);
  EXPECT_EQ(sink_.samples.size(), 33U);
  EXPECT_EQ(counters().incomplete, 0U);
  EXPECT_EQ(counters().late, 0U);
  ExpectAllAccountedFor();
}

// What a flipped bit in the header can do.
TEST_F(AssemblerTest, LosesOnlyTheDatagramWithADamagedHeader) {
  LearnFrom(1);
  std::uint32_t counter = 7;
  int wild = 0;
  for (std::size_t byte = 6; byte < 16; ++byte) {  // sample counter, part, items, time code
    if (byte == 10 || byte == 11) continue;
    for (int bit = 0; bit < 8; ++bit) {
      auto datagrams = Datagrams(counter++);
      std::string& damaged = datagrams[wild % 2 == 0 ? 0 : 4];  // the pose, or the last
      damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << bit));
      Send(datagrams);
      Wait(kPeriod);
      Send(Datagrams(counter++));
      Wait(kPeriod);
      ++wild;
    }
  }
  Send(Datagrams(counter++));
  // Every sample but those whose pose was the damaged datagram came, complete or not, once.
  const auto given = GivenCounters();
  EXPECT_TRUE(std::is_sorted(given.begin(), given.end()));
  EXPECT_EQ(std::set<std::uint32_t>(given.begin(), given.end()).size(), given.size());
  EXPECT_GE(given.size(), counter - 7 - static_cast<std::size_t>(wild) / 2);
  for (std::uint32_t undamaged = 8; undamaged < counter; undamaged += 2) {
    EXPECT_THAT(given, ::testing::Contains(undamaged));
  }
  EXPECT_EQ(counters().restarts, 0U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, AddsNoPersonForOneDatagramOfAnUnknownCharacter) {
  LearnFrom(1);
  Send(Datagrams(7, 77)[0]);
  for (std::uint32_t counter = 7; counter < 1000; ++counter) {
    assembler_.Expire(now_, sink_);
    Send(Datagrams(counter));
    Wait(kPeriod);
  }
  for (const BodySample& sample : sink_.samples) EXPECT_EQ(sample.character, 0);
  for (const Character& character : sink_.characters) EXPECT_EQ(character.id, 0);
  EXPECT_EQ(counters().outliers, 1U);
  ExpectAllAccountedFor();
}

TEST_F(AssemblerTest, BuildsThePoseFromType01IfItIsTheOnlyOne) {
  for (std::uint32_t counter = 1; counter < 5; ++counter) {
    RawDatagram raw;
    raw.type = "01";
    raw.counter = counter;
    raw.time_code_millis = counter * 4;
    raw.items = 23;
    raw.payload = testing::Items(1, 23, 6, 90);
    Send(raw.Bytes());
    Wait(kPeriod);
  }
  ExpectAllAccountedFor();
  ASSERT_EQ(sink_.samples.size(), 4U);
  EXPECT_TRUE(sink_.samples[0].segments[0].position.isApprox(Eigen::Vector3d(0.9, 0.9, 0.9), 1e-6));
}

TEST_F(AssemblerTest, TreatsTrackedObjectsAsASeparateCharacter) {
  RawDatagram raw;
  raw.items = raw.body_segments = 3;
  raw.payload = PoseItems(1, 3);
  raw.character = 1;
  for (raw.counter = 1; raw.counter < 8; ++raw.counter) {
    raw.time_code_millis = raw.counter * 1000 / 240;
    Send(Datagrams(raw.counter));
    Send(raw.Bytes());
    Wait(kPeriod);
  }
  ExpectAllAccountedFor();
  EXPECT_EQ(sink_.samples.size(), 7U);
  ASSERT_EQ(sink_.objects.size(), 7U);
  EXPECT_EQ(sink_.objects[0].character, 1);
  EXPECT_EQ(sink_.objects[0].present.count(), 3U);
  EXPECT_NEAR(sink_.objects[6].stamp_nanos, sink_.samples[6].stamp_nanos, kNanosPerMilli);
}

TEST_F(AssemblerTest, DeliversGlovesPropsTrackersAndTimeOfDay) {
  RawDatagram raw;
  raw.props = 2;
  raw.fingers = 40;
  raw.items = 65;
  raw.payload = PoseItems(1, 65);
  Send(raw.Bytes());
  raw.type = "23";
  raw.items = 17;
  raw.payload = testing::Items(1, 17, 16, 0.5, 0);
  Send(raw.Bytes());
  raw.type = "25";
  raw.items = 1;
  raw.payload = testing::FromHex("0000000c") + "00:00:01.500";
  Send(raw.Bytes());
  ExpectAllAccountedFor();
  ASSERT_EQ(sink_.samples.size(), 1U);
  const BodySample& sample = sink_.samples[0];
  EXPECT_EQ(sample.fingers_and_props.present.count(), 42U);
  EXPECT_TRUE(sample.fingers_and_props.present.test(static_cast<std::size_t>(PropIndex(1))));
  EXPECT_FALSE(sample.fingers_and_props.present.test(static_cast<std::size_t>(PropIndex(2))));
  EXPECT_EQ(sample.has_tracker.count(), 17U);
  EXPECT_EQ(sample.utc_millis_of_day, 1500);
}

TEST_F(AssemblerTest, UsesReceiveTimesAsTimeStampsOnRequest) {
  Assembler assembler({Stamps::kArrival, Delivery::kPrompt});
  for (std::uint32_t counter = 1; counter < 40; ++counter) {
    const std::int64_t jitter = random_.Integer(0, 3) * kNanosPerMilli;
    now_ += jitter;
    for (const std::string& datagram : Datagrams(counter)) {
      assembler.Add(sender_, datagram, now(), sink_);
    }
    now_ += kPeriod - jitter;
    if (sink_.samples.size() < 10) continue;
    EXPECT_EQ(sink_.samples.back().stamp_nanos, now().wall_nanos - kPeriod + jitter);
  }
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
      const auto delay = [&] {
        return random_.Coin(0.1) ? random_.Integer(0, 9) * kNanosPerMilli : 0;
      };
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
