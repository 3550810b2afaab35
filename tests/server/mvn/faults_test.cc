#include "server/mvn/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/system/errors.h"
#include "server/mvn/encode.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kPeriod = 1'000'000'000 / 120;
constexpr int kPerSample = 4;

struct Sent {
  std::int64_t due_nanos = 0;
  std::string bytes;
};

// Datagrams that can be told apart: `samples` of `kPerSample`, all of a sample due at once.
std::vector<Sent> Stream(int samples, int character = 0) {
  std::vector<Sent> stream;
  for (int i = 0; i < samples; ++i) {
    testing::RawDatagram raw;
    raw.counter = 5000U + static_cast<std::uint32_t>(i);
    raw.time_code_millis = 70'000U + static_cast<std::uint32_t>(std::lround(i * 1000.0 / 120));
    raw.character = character;
    for (const char* type : {"02", "21", "22", "24"}) {
      raw.type = type;
      const std::string digits = type;
      raw.items = 1;
      if (digits == "02") raw.payload = testing::PoseItems(1, 1);
      if (digits == "21") raw.payload = testing::Items(1, 1, 9, 1);
      if (digits == "22") raw.payload = testing::Items(1, 1, 10, 1, 0);
      if (digits == "24") raw.payload = testing::Items(1, 1, 8, 1);
      stream.push_back({1'000'000 + i * kPeriod, raw.Bytes()});
    }
  }
  return stream;
}

struct Received {
  std::vector<TimedDatagram> datagrams;
  std::vector<Injection> injections;

  std::vector<std::string> Bytes() const {
    std::vector<std::string> bytes;
    for (const TimedDatagram& datagram : datagrams) bytes.push_back(datagram.bytes);
    return bytes;
  }
};

// As a sender does it: nothing is taken that is due after what is still to be added.
Received Pass(FaultInjector& injector, const std::vector<Sent>& stream) {
  Received received;
  injector.set_listener([&](const Injection& one) { received.injections.push_back(one); });
  const auto take_until = [&](std::int64_t nanos) {
    while (injector.next_send_nanos() && *injector.next_send_nanos() < nanos) {
      const std::int64_t announced = *injector.next_send_nanos();
      received.datagrams.push_back(injector.Take());
      EXPECT_EQ(received.datagrams.back().send_nanos, announced);
    }
  };
  for (const Sent& sent : stream) {
    take_until(sent.due_nanos);
    injector.Add(sent.bytes, sent.due_nanos);
  }
  injector.End();
  take_until(std::numeric_limits<std::int64_t>::max());
  for (std::size_t i = 1; i < received.datagrams.size(); ++i) {
    EXPECT_GE(received.datagrams[i].send_nanos, received.datagrams[i - 1].send_nanos);
  }
  return received;
}

FaultSettings Only(const std::string& text) {
  FaultSettings settings;
  SetFault(text, settings);
  return settings;
}

Header HeaderOf(const std::string& bytes) { return ParseHeader(bytes).value(); }

// A share of `count` draws, give or take five standard deviations.
::testing::Matcher<std::uint64_t> IsShare(double share, std::size_t count) {
  const double mean = share * static_cast<double>(count);
  const double slack = 5 * std::sqrt(mean * (1 - share));
  return ::testing::AllOf(::testing::Ge(static_cast<std::uint64_t>(mean - slack)),
                          ::testing::Le(static_cast<std::uint64_t>(mean + slack)));
}

// Where each datagram of `stream` came out, by its first arrival; -1 where it did not.
std::vector<int> PlacesOf(const std::vector<Sent>& stream, const Received& received) {
  std::map<std::string, int> places;
  for (std::size_t i = 0; i < received.datagrams.size(); ++i) {
    places.emplace(received.datagrams[i].bytes, static_cast<int>(i));
  }
  std::vector<int> result;
  for (const Sent& sent : stream) {
    const auto found = places.find(sent.bytes);
    result.push_back(found == places.end() ? -1 : found->second);
  }
  return result;
}

TEST(Faults, ChangeNeitherBytesNorTimesIfAllAreOff) {
  FaultInjector injector(FaultSettings(), 1);
  const auto stream = Stream(50);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  for (std::size_t i = 0; i < stream.size(); ++i) {
    EXPECT_EQ(received.datagrams[i].bytes, stream[i].bytes);
    EXPECT_EQ(received.datagrams[i].send_nanos, stream[i].due_nanos);
  }
  EXPECT_TRUE(received.injections.empty());
}

TEST(Faults, AreReproducibleForTheSameSeedOnly) {
  const auto stream = Stream(2000);
  const auto run = [&](std::uint64_t seed) {
    FaultInjector injector(Only("all=0.02"), seed);
    return Pass(injector, stream).Bytes();
  };
  EXPECT_EQ(run(7), run(7));
  EXPECT_NE(run(7), run(8));
}

TEST(Faults, LoseTheGivenShareAndKeepTheRestInOrder) {
  FaultInjector injector(Only("loss=0.05"), 2);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  const std::uint64_t lost = injector.count(Fault::kLoss).injected;
  EXPECT_THAT(lost, IsShare(0.05, stream.size()));
  EXPECT_EQ(received.datagrams.size() + lost, stream.size());
  EXPECT_EQ(received.injections.size(), lost);
  int before = -1;
  for (const int place : PlacesOf(stream, received)) {
    if (place < 0) continue;
    EXPECT_EQ(place, before + 1);
    before = place;
  }
}

TEST(Faults, RepeatDatagramsAtMostThreePlacesLater) {
  FaultInjector injector(Only("duplicate=0.05"), 3);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  const std::uint64_t repeated = injector.count(Fault::kDuplicate).injected;
  EXPECT_THAT(repeated, IsShare(0.05, stream.size()));
  EXPECT_EQ(received.datagrams.size(), stream.size() + repeated);
  std::map<std::string, std::size_t> first;
  std::set<std::size_t> distances;
  for (std::size_t i = 0; i < received.datagrams.size(); ++i) {
    const auto [found, is_new] = first.emplace(received.datagrams[i].bytes, i);
    if (!is_new) distances.insert(i - found->second - 1);
  }
  EXPECT_EQ(first.size(), stream.size());
  // Copies may be between a datagram and its copy.
  EXPECT_TRUE(distances.count(0) == 1 && distances.count(3) == 1);
  EXPECT_LE(*distances.rbegin(), 6U);
}

TEST(Faults, MoveDatagramsBackByOneToThreePlaces) {
  FaultInjector injector(Only("reorder=0.05"), 4);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  EXPECT_EQ(received.datagrams.size(), stream.size());
  const auto places = PlacesOf(stream, received);
  std::uint64_t overtaken = 0;  // datagrams that a later one went before
  std::set<int> by;
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    int passed_by = 0;
    for (int k = i + 1; k < std::min<int>(i + 10, static_cast<int>(places.size())); ++k) {
      passed_by +=
          places[static_cast<std::size_t>(k)] < places[static_cast<std::size_t>(i)] ? 1 : 0;
    }
    if (passed_by == 0) continue;
    ++overtaken;
    by.insert(passed_by);
  }
  EXPECT_THAT(by, ::testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(injector.count(Fault::kReorder).injected, IsShare(0.05, stream.size()));
  // Two that were put back side by side may have passed each other again.
  EXPECT_NEAR(static_cast<double>(overtaken),
              static_cast<double>(injector.count(Fault::kReorder).injected), overtaken * 0.05);
}

TEST(Faults, DelayByJitterWithoutChangingTheOrder) {
  FaultInjector injector(Only("jitter=0.05:0.002"), 5);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  std::int64_t longest = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    EXPECT_EQ(received.datagrams[i].bytes, stream[i].bytes);
    const std::int64_t delay = received.datagrams[i].send_nanos - stream[i].due_nanos;
    EXPECT_GE(delay, 0);
    EXPECT_LE(delay, 2'000'000);
    longest = std::max(longest, delay);
  }
  EXPECT_GT(longest, 1'900'000);
  EXPECT_THAT(injector.count(Fault::kJitter).injected, IsShare(0.05, stream.size()));
}

TEST(Faults, DelayTheGivenShareOfTimeAndSendItAtOnce) {
  FaultInjector injector(Only("burst=0.05"), 6);
  const auto stream = Stream(7200);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  std::set<std::int64_t> bursts;
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    EXPECT_EQ(received.datagrams[i].bytes, stream[i].bytes);
    const std::int64_t delay = received.datagrams[i].send_nanos - stream[i].due_nanos;
    EXPECT_LE(delay, 100'000'000);
    if (delay == 0) continue;
    bursts.insert(received.datagrams[i].send_nanos);
    ++held;
  }
  EXPECT_EQ(bursts.size(), 30U) << "60 s, one of 0.1 s in every 2 s";
  EXPECT_EQ(injector.count(Fault::kBurst).injected, bursts.size());
  EXPECT_EQ(injector.count(Fault::kBurst).datagrams, held);
  EXPECT_NEAR(static_cast<double>(held), 0.05 * static_cast<double>(stream.size()),
              30.0 * kPerSample);
}

TEST(Faults, TruncateDatagramsAnywhereAndReportWhetherThatIsDetectable) {
  FaultInjector injector(Only("truncate=0.05"), 7);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  std::uint64_t rejected = 0, cut = 0;
  bool cut_to_nothing = false;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const std::string& bytes = received.datagrams[i].bytes;
    if (bytes == stream[i].bytes) continue;
    ++cut;
    EXPECT_EQ(bytes, stream[i].bytes.substr(0, bytes.size()));
    rejected += ParseDatagram(bytes) ? 0U : 1U;
    cut_to_nothing |= bytes.empty();
  }
  const FaultCount& count = injector.count(Fault::kTruncate);
  EXPECT_THAT(cut, IsShare(0.05, stream.size()));
  EXPECT_EQ(count.injected, cut);
  EXPECT_EQ(count.detectable, rejected);
  EXPECT_EQ(count.undetectable, cut - rejected);
  EXPECT_TRUE(cut_to_nothing);
}

TEST(Faults, CorruptOneToFourBytesAndReportTheResultOfTheParser) {
  FaultInjector injector(Only("corrupt=0.05"), 8);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  std::set<int> changed_bytes;
  std::size_t corrupt = 0;
  std::uint64_t rejected = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const std::string& bytes = received.datagrams[i].bytes;
    ASSERT_EQ(bytes.size(), stream[i].bytes.size());
    if (bytes == stream[i].bytes) continue;
    int changed = 0;
    for (std::size_t k = 0; k < bytes.size(); ++k) changed += bytes[k] != stream[i].bytes[k];
    changed_bytes.insert(changed);
    const auto parsed = ParseDatagram(bytes);
    rejected += parsed ? 0U : 1U;
    const Injection& told = received.injections.at(corrupt++);
    EXPECT_EQ(told.header->sample_counter, HeaderOf(stream[i].bytes).sample_counter);
    EXPECT_EQ(told.claimed.has_value(), parsed.has_value());
    if (parsed) {
      EXPECT_EQ(told.claimed->sample_counter, parsed->header.sample_counter);
    } else {
      EXPECT_EQ(told.rejected_for, parsed.error().reason);
    }
  }
  EXPECT_THAT(changed_bytes, ::testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(corrupt, IsShare(0.05, stream.size()));
  EXPECT_EQ(injector.count(Fault::kCorrupt).injected, corrupt);
  EXPECT_EQ(injector.count(Fault::kCorrupt).detectable, rejected);
  EXPECT_EQ(injector.count(Fault::kCorrupt).undetectable, corrupt - rejected);
  EXPECT_GT(rejected, 0U);
  EXPECT_LT(rejected, corrupt);
}

TEST(Faults, InsertForeignTextsThatTheParserRejectsByReason) {
  FaultInjector injector(Only("foreign=0.05"), 9);
  const auto stream = Stream(5000);
  const Received received = Pass(injector, stream);
  const std::uint64_t inserted = injector.count(Fault::kForeign).injected;
  EXPECT_THAT(inserted, IsShare(0.05, stream.size()));
  ASSERT_EQ(received.datagrams.size(), stream.size() + inserted);
  std::map<Reason, int> reasons;
  for (const Injection& injection : received.injections) ++reasons[injection.rejected_for];
  std::map<Reason, int> seen;
  for (const TimedDatagram& datagram : received.datagrams) {
    if (const auto parsed = ParseDatagram(datagram.bytes); !parsed) ++seen[parsed.error().reason];
  }
  EXPECT_EQ(seen, reasons);
  EXPECT_THAT(reasons, ::testing::UnorderedElementsAre(
                           ::testing::Key(Reason::kJsonText), ::testing::Key(Reason::kXmlText),
                           ::testing::Key(Reason::kForeignText), ::testing::Key(Reason::kForeign)));
}

TEST(Faults, InterruptTheStreamForTheGivenShareOfTime) {
  FaultInjector injector(Only("silence=0.05"), 10);
  const auto stream = Stream(7200);
  const Received received = Pass(injector, stream);
  const FaultCount& count = injector.count(Fault::kSilence);
  EXPECT_EQ(count.injected, 3U) << "60 s, one of 1 s in every 20 s";
  EXPECT_EQ(received.datagrams.size() + count.datagrams, stream.size());
  EXPECT_NEAR(static_cast<double>(count.datagrams), 0.05 * static_cast<double>(stream.size()),
              3.0 * kPerSample);
  int pauses = 0;
  for (std::size_t i = 1; i < received.datagrams.size(); ++i) {
    const std::int64_t pause =
        received.datagrams[i].send_nanos - received.datagrams[i - 1].send_nanos;
    if (pause <= kPeriod + 1) continue;
    ++pauses;
    EXPECT_NEAR(static_cast<double>(pause), 1e9, 2.0 * kPeriod);
  }
  EXPECT_EQ(pauses, 3);
}

TEST(Faults, ResetCountersAndTimeCodesTogetherForAWholeSample) {
  FaultInjector injector(Only("reset=0.05"), 11);
  const auto stream = Stream(7200);
  const Received received = Pass(injector, stream);
  ASSERT_EQ(received.datagrams.size(), stream.size());
  EXPECT_EQ(injector.count(Fault::kReset).injected, 3U) << "60 s, one in every 20 s";
  std::uint32_t base = 0, time_base = 0;
  int resets = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const Header came = HeaderOf(received.datagrams[i].bytes);
    const Header sent = HeaderOf(stream[i].bytes);
    if (came.sample_counter == 0 && i % kPerSample == 0) {
      ++resets;
      base = sent.sample_counter;
      time_base = sent.time_code_millis;
    }
    EXPECT_EQ(came.sample_counter, sent.sample_counter - base);
    EXPECT_EQ(came.time_code_millis, sent.time_code_millis - time_base);
    EXPECT_EQ(received.datagrams[i].bytes.substr(kHeaderBytes),
              stream[i].bytes.substr(kHeaderBytes));
  }
  EXPECT_EQ(resets, 3);
}

TEST(Faults, ResetNoCharactersAndNoScaleData) {
  FaultInjector injector(Only("reset=1"), 12);
  auto stream = Stream(600);
  Character character;
  character.skeleton = urdf::DefaultSkeleton();
  const auto datagrams = EncodeCharacter(character);
  for (const std::string& datagram : datagrams) {
    stream.push_back({stream.back().due_nanos, datagram});
  }
  const Received received = Pass(injector, stream);
  EXPECT_GT(injector.count(Fault::kReset).injected, 3U);
  EXPECT_EQ(received.datagrams.back().bytes, datagrams.back());
}

// What was put back or repeated does not hang in the air for as long as nothing follows.
TEST(Faults, DelayNothingThroughAnInterruption) {
  FaultSettings settings = Only("reorder=1");
  SetFault("silence=0.5", settings);
  FaultInjector injector(settings, 13);
  const auto stream = Stream(1200);
  const Received received = Pass(injector, stream);
  std::map<std::string, std::int64_t> due;
  for (const Sent& sent : stream) due[sent.bytes] = sent.due_nanos;
  for (const TimedDatagram& datagram : received.datagrams) {
    EXPECT_LE(datagram.send_nanos - due.at(datagram.bytes), kPeriod + 1);
  }
}

TEST(Faults, DelayNothingUntilTheEndOfABurst) {
  FaultSettings settings = Only("reorder=0.5");
  SetFault("burst=0.5", settings);
  FaultInjector injector(settings, 14);
  const auto stream = Stream(1200);
  const Received received = Pass(injector, stream);
  std::map<std::string, std::int64_t> due;
  for (const Sent& sent : stream) due[sent.bytes] = sent.due_nanos;
  std::set<std::int64_t> bursts;
  for (const TimedDatagram& datagram : received.datagrams) {
    const std::int64_t delay = datagram.send_nanos - due.at(datagram.bytes);
    if (delay > kPeriod + 1) bursts.insert(datagram.send_nanos);
  }
  EXPECT_LE(bursts.size(), injector.count(Fault::kBurst).injected) << "the bursts, nothing else";
}

TEST(Faults, AreSetByNameShareAndSeconds) {
  FaultSettings settings;
  SetFault("all=0.01", settings);
  SetFault("burst=0.2:0.5", settings);
  EXPECT_EQ(settings[Fault::kLoss], 0.01);
  EXPECT_EQ(settings[Fault::kBurst], 0.2);
  EXPECT_EQ(settings.burst_secs, 0.5);
  const auto error_of = [&](const std::string& text) -> std::string {
    try {
      SetFault(text, settings);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(error_of("loss"), HasSubstr("FAULT=SHARE"));
  EXPECT_THAT(error_of("los=0.1"), ::testing::AllOf(HasSubstr("los=0.1"), HasSubstr("corrupt")));
  EXPECT_THAT(error_of("loss=1.5"), ::testing::AllOf(HasSubstr("loss=1.5"), HasSubstr("0 to 1")));
  EXPECT_THAT(error_of("loss=nan"), HasSubstr("0 to 1"));
  EXPECT_THAT(error_of("loss=0.1x"), HasSubstr("0 to 1"));
  EXPECT_THAT(error_of("loss=0.1:3"), HasSubstr("seconds"));
  EXPECT_THAT(error_of("silence=0.1:0"), HasSubstr("0.001 to 60"));
}

}  // namespace
}  // namespace kinescope::mvn
