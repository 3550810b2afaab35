// What becomes of a stream when network and sender misbehave: half a minute of a suit's stream
// through each fault, in virtual time. Every sample that no fault has touched must arrive exactly
// once, in order, with the values that were sent; what was injected must be found in the counters;
// memory must not grow.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <bitset>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "server/mvn/faults.h"
#include "tests/sanitized.h"
#include "tests/server/mvn/assembler_fixture.h"

namespace kinescope::mvn {
namespace {

using testing::RandomValues;

constexpr double kRateHz = 120;
constexpr int kSeconds = 30;
constexpr int kSamples = static_cast<int>(kRateHz) * kSeconds;
constexpr std::uint32_t kFirstCounter = 5000;
constexpr std::int64_t kStart = 7'000'000'000;
constexpr std::int64_t kWallStart = 1'700'000'000'000'000'000;
constexpr double kFloatNoise = 1e-6;

// Samples before which a stream cannot know what it normally sends.
constexpr int kSamplesToLearn = 10;

using Types = std::bitset<26>;

std::size_t Index(Type type) { return static_cast<std::size_t>(type); }

// What happened to one sample on its way.
struct Fate {
  std::uint32_t sent_counter = 0;  // after resets
  Types came;                      // messages that arrived undamaged
  bool is_garbled = false;         // a damaged message of it, or one that claims to be, got through
  int arrivals = 0;

  bool IsWhole() const { return came.count() == 5; }
  bool HasPose() const {
    return came[Index(Type::kPose)] || (came[Index(Type::kLinear)] && came[Index(Type::kAngular)]);
  }
};

std::int64_t LiveBytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

// The samples that are sent, the same in each test.
const BodySample& SentSample(int index) {
  static const std::vector<BodySample> sent = [] {
    std::vector<BodySample> samples;
    samples.reserve(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      RandomValues random(i);
      const std::uint32_t counter = kFirstCounter + i;
      samples.push_back(testing::RandomSample(random, counter));
      samples.back().time_code_millis = std::llround(counter * 1000 / kRateHz);
    }
    return samples;
  }();
  return sent[static_cast<std::size_t>(index)];
}

// What is wrong with `came`, of which `types` arrived; "" if nothing.
std::string Difference(const BodySample& came, const BodySample& sent, const Types& types) {
  const auto has = [&](Type type) { return types[Index(type)]; };
  if (came.has_linear != has(Type::kLinear)) return "has_linear";
  if (came.has_angular != has(Type::kAngular)) return "has_angular";
  if (came.com.has_value() != has(Type::kCenterOfMass)) return "com";
  if (came.streamed_angles_deg.has_value() != has(Type::kJointAngles)) return "angles";
  for (std::size_t i = 0; i < sent.segments.size(); ++i) {
    const SegmentState &a = came.segments[i], &b = sent.segments[i];
    if (a.position != b.position) return "position";
    if (a.orientation.angularDistance(b.orientation) > kFloatNoise) return "orientation";
    if (came.has_linear && a.velocity != b.velocity) return "velocity";
    if (came.has_linear && a.acceleration != b.acceleration) return "acceleration";
    if (came.has_angular && a.angular_velocity != b.angular_velocity) return "angular velocity";
    if (came.has_angular && a.angular_acceleration != b.angular_acceleration) {
      return "angular acceleration";
    }
  }
  if (came.com && came.com->position != sent.com->position) return "com position";
  if (came.com && came.com->velocity != sent.com->velocity) return "com velocity";
  if (came.streamed_angles_deg && *came.streamed_angles_deg != *sent.streamed_angles_deg) {
    return "angle";
  }
  return "";
}

// Half a minute of one person's stream, through faults, into an assembler.
class FaultyStream : private SampleSink {
 public:
  FaultyStream(const FaultSettings& settings, std::uint64_t seed) : faults_(settings, seed) {
    fates_.resize(kSamples);
    faults_.set_listener([this](const Injection& injection) { OnInjection(injection); });
    character_.name = "Ines";
    character_.skeleton = urdf::DefaultSkeleton();
  }

  void Run() {
    for (sending_ = 0; sending_ < kSamples; ++sending_) {
      if (sending_ == kSamples / 2) live_bytes_at_half_ = live_bytes_;
      SendOne(kStart + std::llround(sending_ * 1e9 / kRateHz));
    }
    faults_.End();
    DeliverBefore(std::numeric_limits<std::int64_t>::max());
    for (int second = 1; second <= 10; ++second) Expire(now_ + 1000 * kNanosPerMilli);
  }

  // What arrived, against what was sent.
  void CheckSamples() const {
    for (const std::string& problem : problems_) ADD_FAILURE() << problem;
    std::vector<int> missing, repeated, from_nothing;
    for (int i = 0; i < kSamples; ++i) {
      const Fate& fate = fates_[static_cast<std::size_t>(i)];
      if (fate.is_garbled) continue;
      if (fate.HasPose() && fate.arrivals == 0) missing.push_back(i);
      if (!fate.HasPose() && fate.arrivals > 0) from_nothing.push_back(i);
      if (fate.arrivals > 1) repeated.push_back(i);
    }
    EXPECT_THAT(missing, ::testing::IsEmpty()) << "samples that never arrived";
    EXPECT_THAT(repeated, ::testing::IsEmpty()) << "samples that arrived more than once";
    EXPECT_THAT(from_nothing, ::testing::IsEmpty()) << "samples without a pose";
    EXPECT_EQ(unexplained_, 0) << "samples that nobody sent";
    EXPECT_EQ(is_description_garbled_ ? "Ines" : last_name_, "Ines");
    EXPECT_EQ(strangers_, 0) << "people that nobody sent";
  }

  // What was counted, against what was injected. A damaged datagram that nobody can tell from a
  // good one may end anywhere, so their number is the slack of some counters, and zero without
  // corruption.
  void CheckCounters() const {
    const SourceCounters counters = assembler_.counters();
    const std::uint64_t slack =
        faults_.count(Fault::kCorrupt).undetectable + faults_.count(Fault::kTruncate).undetectable;
    const auto is_about = [&](std::uint64_t low, std::uint64_t high) {
      return ::testing::AllOf(::testing::Ge(low - std::min(low, slack)),
                              ::testing::Le(high + slack));
    };
    EXPECT_EQ(assembler_.tally().settled(), assembler_.tally().datagrams)
        << "a datagram ended nowhere, or twice";
    EXPECT_EQ(counters.datagrams, delivered_);
    EXPECT_EQ(counters.restarts, faults_.count(Fault::kReset).injected);
    EXPECT_THAT(counters.duplicates, is_about(duplicates_, duplicates_));
    EXPECT_THAT(counters.late, is_about(0, 0));
    EXPECT_THAT(counters.outliers, is_about(0, 0));

    std::uint64_t given = 0, incomplete = 0, incomplete_while_learning = 0, gaps = 0;
    std::uint64_t without_pose = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Fate& fate = fates_[static_cast<std::size_t>(i)];
      given += fate.HasPose() ? 1 : 0;
      if (fate.HasPose() && !fate.IsWhole()) {
        ++(i < kSamplesToLearn ? incomplete_while_learning : incomplete);
      }
      if (!fate.HasPose()) without_pose += fate.came.count();
      const bool is_heard = fate.came.any();
      const bool was_heard = i > 0 && fates_[static_cast<std::size_t>(i) - 1].came.any();
      // A reset starts another count; what was lost before it cannot be known.
      if (is_heard && !was_heard && i > 0 && !IsFirstHeardOfRun(i)) ++gaps;
    }
    EXPECT_THAT(counters.samples, is_about(given, given));
    EXPECT_THAT(counters.incomplete, is_about(incomplete, incomplete + incomplete_while_learning));
    EXPECT_THAT(counters.counter_gaps, is_about(gaps, gaps));

    // By reason: those of the parser exactly.
    for (int i = 0; i <= static_cast<int>(Reason::kTimeOfDay); ++i) {
      const auto reason = static_cast<Reason>(i);
      EXPECT_EQ(RejectedFor(counters, reason), Told(reason)) << Text(reason);
    }
    EXPECT_THAT(RejectedFor(counters, Reason::kNoWholePose), is_about(without_pose, without_pose));
    for (const Reason reason : {Reason::kTooManyStreams, Reason::kSecondSender}) {
      EXPECT_EQ(RejectedFor(counters, reason), 0U) << Text(reason);
    }
  }

  void CheckMemory() const {
    if (LiveBytes() == 0) return;  // a sanitizer's malloc does not tell
    // What is kept of a person's scale data depends on which part of it came last.
    constexpr std::int64_t kOnePerson = 16384;
    EXPECT_LE(live_bytes_ - live_bytes_at_half_, kOnePerson)
        << "bytes more than after the first half, in " << delivered_ / 2 << " datagrams";
  }

  std::uint64_t injected(Fault fault) const { return faults_.count(fault).injected; }

 private:
  void SendOne(std::int64_t due) {
    const bool describe = sending_ % static_cast<int>(kRateHz) == 0;
    is_character_ = true;
    if (describe) {
      is_description_garbled_ = false;
      for (const std::string& datagram : EncodeCharacter(character_)) Add(datagram, due);
    }
    is_character_ = false;
    const std::uint32_t counter = kFirstCounter + static_cast<std::uint32_t>(sending_);
    Fate& fate = fates_[static_cast<std::size_t>(sending_)];
    fate.sent_counter = counter - base_;
    for (const std::string& datagram : EncodeSample(SentSample(sending_))) {
      adding_ = Index(ParseHeader(datagram)->type);
      fate.came.set(adding_);
      Add(datagram, due);
    }
    by_counter_[fate.sent_counter].push_back(sending_);
  }

  void Add(const std::string& datagram, std::int64_t due) {
    DeliverBefore(due);
    faults_.Add(datagram, due);
  }

  void OnInjection(const Injection& injection) {
    Fate& fate = fates_[static_cast<std::size_t>(std::min(sending_, kSamples - 1))];
    switch (injection.fault) {
      case Fault::kDuplicate:
        if (BelongsToSample(injection.header->type)) {
          ++duplicates_;  // 12 and 13 are repeated anyway
        }
        return;
      case Fault::kReset:
        base_ = kFirstCounter + static_cast<std::uint32_t>(sending_);
        run_starts_.insert(sending_);
        fate.sent_counter = 0;
        return;
      case Fault::kTruncate:
      case Fault::kCorrupt:
        if (injection.claimed) {
          claimed_.insert(injection.claimed->sample_counter);
          (is_character_ ? is_description_garbled_ : fate.is_garbled) = true;
        } else {
          ++told_[injection.rejected_for];
        }
        if (!is_character_) fate.came.reset(adding_);
        return;
      case Fault::kLoss:
      case Fault::kSilence:
        if (!is_character_) fate.came.reset(adding_);
        return;
      case Fault::kForeign: ++told_[injection.rejected_for]; return;
      case Fault::kReorder:
      case Fault::kJitter:
      case Fault::kBurst: return;
    }
  }

  void DeliverBefore(std::int64_t nanos) {
    while (faults_.next_send_nanos().value_or(nanos) < nanos) {
      const TimedDatagram datagram = faults_.Take();
      Expire(datagram.send_nanos);
      ++delivered_;
      Watch([&] {
        assembler_.Add(testing::Sender(1), datagram.bytes,
                       {datagram.send_nanos, kWallStart + datagram.send_nanos}, *this);
      });
    }
  }

  // As a source does: at each deadline until `nanos`.
  void Expire(std::int64_t nanos) {
    now_ = std::max(now_, nanos);
    while (assembler_.deadline_nanos().value_or(nanos + 1) <= nanos) {
      const std::int64_t deadline = *assembler_.deadline_nanos();
      Watch([&] { assembler_.Expire(deadline, *this); });
      const auto next = assembler_.deadline_nanos();
      ASSERT_TRUE(!next || *next > deadline) << "a deadline that Expire() does not meet";
    }
  }

  // What `action` leaves allocated is the assembler's, not the test's.
  template <class Action>
  void Watch(const Action& action) {
    const std::int64_t before = LiveBytes();
    action();
    live_bytes_ += LiveBytes() - before;
    for (const BodySample* sample = given_; sample != given_ + given_count_; ++sample) {
      Judge(*sample);
    }
    given_count_ = 0;
  }

  void OnCharacter(const Character& character) override {
    last_name_.assign(character.name, 0, kLongestNoted);
    strangers_ += character.id == 0 ? 0 : 1;
  }

  void OnSample(const BodySample& sample) override {
    strangers_ += sample.character == 0 ? 0 : 1;
    ASSERT_LT(given_count_, kMaxGiven);
    given_[given_count_++] = sample;
  }

  void Judge(const BodySample& came) {
    const auto found = by_counter_.find(came.counter);
    std::string difference = "no sample had this counter";
    // Counters repeat after a reset; the values tell.
    if (found != by_counter_.end()) {
      for (const int index : found->second) {
        Fate& fate = fates_[static_cast<std::size_t>(index)];
        difference = Difference(came, SentSample(index), fate.came);
        if (!difference.empty()) continue;
        ++fate.arrivals;
        if (index <= last_index_) Problem(came, "it comes after sample " + Number(last_index_));
        if (came.stamp_nanos <= last_stamp_) Problem(came, "its stamp is not after the last one");
        last_index_ = std::max(last_index_, index);
        last_stamp_ = came.stamp_nanos;
        return;
      }
      for (const int index : found->second) {
        if (fates_[static_cast<std::size_t>(index)].is_garbled) return;
      }
    }
    if (claimed_.count(came.counter) > 0) return;
    ++unexplained_;
    Problem(came, "it is none of those sent: " + difference);
  }

  static std::string Number(int index) { return std::to_string(index); }

  void Problem(const BodySample& sample, const std::string& what) {
    constexpr std::size_t kMaxProblems = 10;
    if (problems_.size() >= kMaxProblems) return;
    problems_.push_back("counter " + std::to_string(sample.counter) + " (while sample " +
                        Number(sending_) + " is sent): " + what);
  }

  bool IsFirstHeardOfRun(int index) const {
    const auto after = run_starts_.upper_bound(index);
    if (after == run_starts_.begin()) return false;
    for (int i = *std::prev(after); i < index; ++i) {
      if (fates_[static_cast<std::size_t>(i)].came.any()) return false;
    }
    return true;
  }

  static std::uint64_t RejectedFor(const SourceCounters& counters, Reason reason) {
    const auto found = counters.rejected.find(Text(reason));
    return found == counters.rejected.end() ? 0 : found->second;
  }
  std::uint64_t Told(Reason reason) const {
    const auto found = told_.find(reason);
    return found == told_.end() ? 0 : found->second;
  }

  static constexpr std::size_t kMaxGiven = 64;
  static constexpr std::size_t kLongestNoted = 64;

  FaultInjector faults_;
  Assembler assembler_{{Stamps::kFitted, Delivery::kPrompt}};
  Character character_;

  std::vector<Fate> fates_;
  std::map<std::uint32_t, std::vector<int>> by_counter_;  // as sent
  std::set<std::uint32_t> claimed_;                       // counters of damaged headers
  std::set<int> run_starts_;                              // samples with which a reset began
  std::map<Reason, std::uint64_t> told_;
  std::uint64_t duplicates_ = 0;
  int sending_ = 0;                      // sample
  std::size_t adding_ = 0;               // type
  bool is_character_ = false;            // 12 and 13 are being added
  bool is_description_garbled_ = false;  // the latest of them, and nobody can tell
  std::uint32_t base_ = 0;

  std::int64_t now_ = 0;
  std::uint64_t delivered_ = 0;
  std::int64_t live_bytes_ = 0;
  std::int64_t live_bytes_at_half_ = 0;

  // What the assembler has just given, kept without allocating.
  BodySample given_[kMaxGiven];
  std::size_t given_count_ = 0;
  std::string last_name_ = std::string(kLongestNoted, ' ');
  int strangers_ = 0;
  int unexplained_ = 0;
  int last_index_ = -1;
  std::int64_t last_stamp_ = 0;
  std::vector<std::string> problems_;
};

struct Case {
  const char* name;
  std::vector<const char*> faults;
  Fault expected;  // must have been injected at all
};

class FaultMatrix : public ::testing::TestWithParam<std::tuple<Case, std::uint64_t>> {};

// Sanitized code is many times slower, and what it looks for shows with any seed.
std::vector<std::uint64_t> Seeds() {
  if (kinescope::testing::kIsSanitized) return {1};
  return {1, 3, 10, 37};
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultMatrix,
    ::testing::Combine(
        ::testing::Values(
            Case{"Loss", {"loss=0.05"}, Fault::kLoss},
            Case{"Duplicate", {"duplicate=0.05"}, Fault::kDuplicate},
            Case{"Reorder", {"reorder=0.05"}, Fault::kReorder},
            Case{"Jitter", {"jitter=0.05"}, Fault::kJitter},
            Case{"Burst", {"burst=0.05"}, Fault::kBurst},
            Case{"Truncate", {"truncate=0.05"}, Fault::kTruncate},
            Case{"Corrupt", {"corrupt=0.05"}, Fault::kCorrupt},
            Case{"Foreign", {"foreign=0.05"}, Fault::kForeign},
            Case{"Silence", {"silence=0.05"}, Fault::kSilence},
            Case{"Reset", {"reset=0.05"}, Fault::kReset},
            Case{"ResetEverySecond", {"reset=1"}, Fault::kReset},
            // A datagram put back into the next sample must not be late by jitter too.
            Case{"All", {"all=0.01", "jitter=0.01:0.002"}, Fault::kLoss}),
        ::testing::ValuesIn(Seeds())),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "Seed" +
             std::to_string(std::get<1>(test.param));
    });

TEST_P(FaultMatrix, LeavesUnaffectedSamplesUnchanged) {
  const auto& [test_case, seed] = GetParam();
  FaultSettings settings;
  for (const char* fault : test_case.faults) SetFault(fault, settings);
  const auto stream = std::make_unique<FaultyStream>(settings, seed);
  stream->Run();
  EXPECT_GT(stream->injected(test_case.expected), 0U);
  stream->CheckSamples();
  stream->CheckCounters();
  stream->CheckMemory();
}

TEST(FaultyStream, CountsNothingWithoutFaults) {
  const auto stream = std::make_unique<FaultyStream>(FaultSettings(), 1);
  stream->Run();
  stream->CheckSamples();
  stream->CheckCounters();
  stream->CheckMemory();
}

}  // namespace
}  // namespace kinescope::mvn
