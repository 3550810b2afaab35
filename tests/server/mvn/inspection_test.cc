#include "server/mvn/inspect/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/duration_histogram.h"
#include "core/system/clocks.h"
#include "server/mvn/encode.h"
#include "server/mvn/open.h"
#include "server/subject/subject.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"

namespace kinescope::mvn {
namespace {

using kinescope::testing::SharedData;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Items;
using testing::PoseItems;
using testing::RandomSample;
using testing::RandomValues;
using testing::RawDatagram;

constexpr std::int64_t kStartWall = 1'700'000'000'000 * kNanosPerMilli;
constexpr std::int64_t kStartMonotonic = 5'000 * kNanosPerMilli;  // monotonic

Endpoint Suit(std::uint8_t host = 20) {
  Endpoint endpoint;
  endpoint.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, host};
  endpoint.port = 51000;
  return endpoint;
}

// Stands for the transport; the test hands datagrams over itself.
struct NoTransport : DatagramSource {
  explicit NoTransport(bool is_live = false) : is_live_(is_live) {}
  State Poll(std::chrono::nanoseconds, DatagramSink&) override { return State::kEnded; }
  TransportCounters counters() const override { return transport; }
  std::string description() const override { return "a test"; }
  bool is_live() const override { return is_live_; }
  TransportCounters transport;
  const bool is_live_;
};

class InspectionTest : public ::testing::Test {
 protected:
  void Send(const std::string& datagram, std::int64_t delay = 0, const Endpoint& from = Suit()) {
    const std::int64_t at = now_ + delay;
    inspection_.OnDatagram({from, {}, datagram, {kStartMonotonic + at, kStartWall + at}});
  }
  void Send(const std::vector<std::string>& datagrams) {
    for (const std::string& datagram : datagrams) Send(datagram);
  }

  // The datagrams of a frame of a suit that captures at 240 Hz; time is when they are due.
  std::vector<std::string> Frame(std::uint32_t counter, const TypeSet& types = UsualTypes(),
                                 int character = 0) {
    BodySample sample = RandomSample(random_, counter);
    sample.character = character;
    return EncodeSample(sample, types);
  }
  void WaitFor(std::uint32_t counter) { now_ = DueNanos(counter); }
  static std::int64_t DueNanos(std::uint32_t counter) {
    return std::int64_t{counter} * 1'000'000'000 / 240;
  }

  // Frames `first` to `last` by `step`; `is_sent` says which of them come.
  void SendFrames(std::uint32_t first, std::uint32_t last, std::uint32_t step = 1,
                  const TypeSet& types = UsualTypes(),
                  const std::function<bool(std::uint32_t)>& is_sent = nullptr) {
    for (std::uint32_t counter = first; counter <= last; counter += step) {
      WaitFor(counter);
      if (!is_sent || is_sent(counter)) Send(Frame(counter, types));
    }
  }

  InspectionReport Report() { return inspection_.Report(transport_); }

  // Of the only one who is there.
  CharacterReport Only() {
    const InspectionReport report = Report();
    EXPECT_EQ(report.characters.size(), 1U);
    return report.characters.empty() ? CharacterReport() : report.characters[0];
  }

  RandomValues random_{11};
  NoTransport transport_;
  Inspection inspection_{false};
  std::int64_t now_ = 0;  // since kStartMonotonic
};

const TypeReport& OfType(const CharacterReport& character, int type) {
  for (const TypeReport& report : character.types) {
    if (report.type == type) return report;
  }
  static const TypeReport kNone;
  ADD_FAILURE() << "type " << type << " is not in the report";
  return kNone;
}

TEST_F(InspectionTest, ReportsSendersTypesAndRates) {
  Character anna;
  anna.name = "Anna";
  anna.color_rgb = 0xE96417;
  anna.skeleton = urdf::DefaultSkeleton(1.68);
  anna.landmarks = urdf::LandmarksOf(*anna.skeleton);
  for (std::uint32_t counter = 0; counter < 480; ++counter) {
    WaitFor(counter);
    if (counter % 240 == 0) Send(EncodeCharacter(anna));
    Send(Frame(counter));
  }
  const InspectionReport report = Report();
  EXPECT_TRUE(report.CanBeShown());
  EXPECT_EQ(report.source, "a test");
  EXPECT_EQ(report.begin_wall_nanos, kStartWall);
  EXPECT_NEAR(report.secs, 479.0 / 240, 1e-6);
  EXPECT_EQ(report.datagrams, 480U * 5 + 2 * 4);
  EXPECT_THAT(report.errors, IsEmpty());
  EXPECT_THAT(report.advice, IsEmpty());
  ASSERT_EQ(report.characters.size(), 1U);
  const CharacterReport& character = report.characters[0];
  EXPECT_EQ(character.sender, "192.168.1.20:51000");
  EXPECT_EQ(character.name, "Anna");
  EXPECT_EQ(character.color_rgb, 0xE96417U);
  EXPECT_EQ(character.kind, CharacterKind::kPerson);
  ASSERT_TRUE(character.height_m);
  EXPECT_NEAR(*character.height_m, 1.68, 1e-3);
  EXPECT_EQ(character.body_segments, 23);
  EXPECT_EQ(character.frames, 480U);
  EXPECT_EQ(character.first_counter, 0U);
  EXPECT_EQ(character.last_counter, 479U);
  EXPECT_EQ(character.usual_step, 1);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_EQ(character.samples, 480U);
  EXPECT_NEAR(character.rate_hz, 240, 0.01);
  EXPECT_NEAR(character.capture_rate_hz, 240, 0.5) << "time codes are whole milliseconds";
  EXPECT_EQ(character.restarts + character.late + character.duplicates + character.outliers, 0U);
  EXPECT_THAT(character.advice, IsEmpty());
  EXPECT_FALSE(character.has_old_header);

  const TypeReport& pose = OfType(character, 2);
  EXPECT_EQ(pose.datagrams, 480U);
  EXPECT_EQ(pose.bytes / pose.datagrams, 760U);
  EXPECT_EQ(pose.fewest_items, 23);
  EXPECT_EQ(pose.most_items, 23);
  EXPECT_EQ(pose.share, 1.0);
  EXPECT_NEAR(pose.rate_hz, 240, 0.01);
  EXPECT_EQ(OfType(character, 12).datagrams, 2U);
  EXPECT_NEAR(OfType(character, 12).rate_hz, 1, 1e-6);
  EXPECT_EQ(OfType(character, 12).share, std::nullopt) << "belongs to no frame";
}

TEST_F(InspectionTest, DistinguishesPeopleObjectsAndSenders) {
  ObjectsSample objects;
  objects.character = 3;
  for (std::size_t i = 0; i < 2; ++i) objects.present.set(i);
  Character cluster;
  cluster.id = 3;
  cluster.name = "Tracked";
  cluster.scaled_segments = {{"HTC Vive 1", {0, 0, 1}}, {"HTC Vive 2", {0, 1, 1}}};
  Send(EncodeCharacter(cluster));
  for (std::uint32_t counter = 100; counter < 200; ++counter) {
    WaitFor(counter);
    Send(Frame(counter, UsualTypes(), 0));
    Send(Frame(counter, UsualTypes(), 1));
    for (const std::string& datagram : Frame(counter, UsualTypes(), 0)) Send(datagram, 0, Suit(21));
    objects.counter = counter;
    objects.time_code_millis = static_cast<std::int64_t>(counter) * 1000 / 240;
    Send(EncodeObjects(objects));
  }
  const InspectionReport report = Report();
  ASSERT_EQ(report.characters.size(), 4U);
  std::set<std::pair<std::string, int>> who;
  for (const CharacterReport& character : report.characters) {
    who.emplace(character.sender, character.id);
    EXPECT_EQ(character.samples, 100U) << character.sender << " " << character.id;
    const bool is_cluster = character.id == 3;
    EXPECT_EQ(character.kind, is_cluster ? CharacterKind::kObjects : CharacterKind::kPerson);
    EXPECT_EQ(character.objects, is_cluster ? 2 : 0);
    if (!is_cluster) continue;
    EXPECT_THAT(character.names, ElementsAre("HTC Vive 1", "HTC Vive 2"));
    EXPECT_THAT(character.advice, IsEmpty()) << "nobody asks objects for their joints";
  }
  EXPECT_EQ(who.size(), 4U);
}

TEST_F(InspectionTest, DetectsGlovesAndPropsByName) {
  Character carrier;
  carrier.name = "Carrier";
  carrier.skeleton = urdf::DefaultSkeleton();
  carrier.scaled_segments.resize(kFingerAndPropCount);
  carrier.scaled_segments[0].name = "Box Generic";
  BodySample sample = RandomSample(random_, 0);
  sample.fingers_and_props.present.set(static_cast<std::size_t>(PropIndex(0)));
  for (int finger = 0; finger < kFingersPerHand; ++finger) {
    sample.fingers_and_props.present.set(
        static_cast<std::size_t>(FingerIndex(urdf::kLeft, finger)));
    sample.fingers_and_props.present.set(
        static_cast<std::size_t>(FingerIndex(urdf::kRight, finger)));
  }
  for (int finger = kMaxProps; finger < kFingerAndPropCount; ++finger) {
    carrier.scaled_segments[static_cast<std::size_t>(finger)].name = FingerOrPropName(finger);
  }
  Send(EncodeCharacter(carrier));
  for (std::uint32_t counter = 0; counter < 20; ++counter) {
    WaitFor(counter);
    sample.counter = counter;
    sample.time_code_millis = static_cast<std::int64_t>(counter) * 1000 / 240;
    Send(EncodeSample(sample, MakeTypeSet({Type::kPose})));
  }
  const CharacterReport character = Only();
  EXPECT_EQ(character.props, 1);
  EXPECT_EQ(character.left_fingers, kFingersPerHand);
  EXPECT_EQ(character.right_fingers, kFingersPerHand);
  EXPECT_THAT(character.names, ElementsAre("Box Generic"));
  EXPECT_EQ(OfType(character, 2).most_items, 23 + 1 + 40);
  EXPECT_EQ(character.quantities.at("gloves"), 20U);
  EXPECT_EQ(character.quantities.at("props"), 20U);
}

TEST_F(InspectionTest, CountsEveryLostSampleAndNoOther) {
  std::uint64_t dropped = 0;
  SendFrames(1000, 3000, 1, UsualTypes(), [&](std::uint32_t counter) {
    const bool is_sent = counter == 1000 || counter == 3000 || !random_.Coin(0.1);
    if (!is_sent) ++dropped;
    return is_sent;
  });
  const CharacterReport character = Only();
  EXPECT_GT(dropped, 150U);
  EXPECT_EQ(character.lost, dropped);
  EXPECT_EQ(character.frames, 2001 - dropped);
  EXPECT_EQ(character.restarts, 0U);
  EXPECT_THAT(character.advice, Contains(HasSubstr("of the frames are lost")));
}

TEST_F(InspectionTest, CountsNoLossIfTheStreamIsSlowerThanTheSuit) {
  SendFrames(0, 2400, 4);
  const CharacterReport character = Only();
  EXPECT_EQ(character.usual_step, 4);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_NEAR(character.rate_hz, 60, 0.01);
  EXPECT_NEAR(character.capture_rate_hz, 240, 0.5);
}

TEST_F(InspectionTest, CountsNoLossForAnAlternatingStep) {
  for (int i = 0; i < 1000; ++i) {  // 100 Hz of 240
    const auto counter = static_cast<std::uint32_t>(i * 24 / 10);
    WaitFor(counter);
    Send(Frame(counter, MakeTypeSet({Type::kPose})));
  }
  const CharacterReport character = Only();
  EXPECT_NEAR(character.usual_step, 2.4, 0.01);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_EQ(character.frames, 1000U);
}

TEST_F(InspectionTest, ReportsTheShareOfSamplesPerType) {
  for (std::uint32_t counter = 0; counter < 400; ++counter) {
    WaitFor(counter);
    Send(Frame(counter, counter % 4 == 0 ? UsualTypes() : MakeTypeSet({Type::kPose})));
  }
  const CharacterReport character = Only();
  EXPECT_EQ(OfType(character, 2).share, 1.0);
  EXPECT_EQ(OfType(character, 24).share, 0.25);
  EXPECT_NEAR(OfType(character, 24).rate_hz, 60, 0.2);
}

TEST_F(InspectionTest, DoesNotCountTheLastSampleAsIncomplete) {
  SendFrames(0, 99);
  for (const std::uint32_t counter : {100U, 101U, 102U}) {
    WaitFor(counter);
    auto frame = Frame(counter);
    if (counter != 101) frame.pop_back();
    Send(frame);
  }
  const CharacterReport character = Only();
  EXPECT_EQ(character.samples, 103U);
  EXPECT_EQ(character.incomplete, 1U) << "100, but not 102";
}

TEST_F(InspectionTest, CountsNoLossForReorderedAndRepeatedDatagrams) {
  SendFrames(1, 100);
  for (std::uint32_t counter = 101; counter < 201; counter += 2) {
    WaitFor(counter);
    const auto first = Frame(counter);
    const auto second = Frame(counter + 1);
    Send(first[0]);  // the two poses change places with the rest of the other frame
    Send(second);
    Send(std::vector<std::string>(first.begin() + 1, first.end()));
    Send(second[0]);
  }
  const CharacterReport character = Only();
  EXPECT_EQ(character.frames, 200U);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_EQ(character.duplicates, 50U);
  EXPECT_EQ(OfType(character, 2).datagrams, 250U);
  EXPECT_EQ(OfType(character, 2).share, 1.0);
}

TEST_F(InspectionTest, CountsARestartAndNoLossIfTheRecordingStartsAgain) {
  SendFrames(5000, 5500);
  const std::int64_t later = DueNanos(6000);
  for (std::uint32_t counter = 0; counter <= 500; ++counter) {
    now_ = later + DueNanos(counter);
    Send(Frame(counter));
  }
  const CharacterReport character = Only();
  EXPECT_EQ(character.restarts, 1U);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_EQ(character.frames, 1002U);
  EXPECT_EQ(character.samples, 1002U);
  EXPECT_NEAR(character.capture_rate_hz, 240, 0.5);
  EXPECT_EQ(character.longest_silence_nanos, DueNanos(6000) - DueNanos(5500));
  EXPECT_EQ(character.longest_silence_at_nanos, DueNanos(5500) - DueNanos(5000));
}

TEST_F(InspectionTest, CountsADamagedHeaderAsOutlierOnly) {
  SendFrames(1, 200);
  RawDatagram wild;
  wild.counter = 0x7F00'0000;
  wild.time_code_millis = 77;
  wild.items = 23;
  wild.payload = PoseItems(1, 23);
  Send(wild.Bytes());
  SendFrames(201, 400);
  const CharacterReport character = Only();
  EXPECT_EQ(character.last_counter, 400U);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_EQ(character.restarts, 0U);
  EXPECT_EQ(character.outliers, 1U);
}

TEST_F(InspectionTest, MeasuresJitterRelativeToTheFastestSamples) {
  // Every tenth frame is 20 ms late (though before the next in order), the others on time.
  for (std::uint32_t counter = 0; counter < 2400; counter += 24) {
    WaitFor(counter);
    for (const std::string& datagram : Frame(counter)) {
      Send(datagram, counter % 240 == 120 ? 20 * kNanosPerMilli : 0);
    }
  }
  const CharacterReport character = Only();
  ASSERT_TRUE(character.delays);
  EXPECT_LT(character.delays->median, kNanosPerMilli) << "time codes are whole milliseconds";
  EXPECT_NEAR(static_cast<double>(character.delays->p95), 20e6, 1e6);
  EXPECT_NEAR(static_cast<double>(character.delays->longest), 20e6, 1e6);
}

TEST_F(InspectionTest, ReportsTheFirstPlaceOfEachFault) {
  SendFrames(0, 240);
  Send(R"({"type":"transport","value":"record"})");
  RawDatagram zero_id;
  zero_id.items = 1;
  zero_id.payload = PoseItems(0, 1);
  for (int i = 0; i < 3; ++i) Send(zero_id.Bytes());
  RawDatagram not_unit;
  not_unit.items = 2;
  not_unit.payload = PoseItems(1, 1) + Items(2, 1, 7, 0.9);
  Send(not_unit.Bytes());
  const InspectionReport report = Report();
  ASSERT_EQ(report.errors.size(), 3U);
  const ErrorReport& most = report.errors[0];
  EXPECT_EQ(most.reason, Text(Reason::kIdZero));
  EXPECT_EQ(most.count, 3U);
  EXPECT_EQ(most.at_nanos, 1000 * kNanosPerMilli);
  EXPECT_EQ(most.sender, "192.168.1.20:51000");
  ASSERT_TRUE(most.where);
  EXPECT_EQ(most.where->value, 0);
  EXPECT_GE(most.where->offset, kHeaderBytes);
  for (const ErrorReport& error : report.errors) {
    if (error.reason != Text(Reason::kNotUnit)) continue;
    ASSERT_TRUE(error.where);
    EXPECT_GT(error.where->offset, kHeaderBytes + 32) << "in the second item";
  }
}

TEST_F(InspectionTest, ReportsAnIncompleteBodyWithoutABytePosition) {
  for (std::uint32_t counter = 0; counter < 20; ++counter) {
    WaitFor(counter);
    RawDatagram part;
    part.counter = counter;
    part.time_code_millis = counter * 1000 / 240;
    part.items = 22;
    part.payload = PoseItems(1, 22);
    Send(part.Bytes());
  }
  const InspectionReport report = Report();
  EXPECT_FALSE(report.CanBeShown());
  ASSERT_EQ(report.errors.size(), 1U);
  EXPECT_EQ(report.errors[0].reason, Text(Reason::kNoWholePose));
  EXPECT_FALSE(report.errors[0].where.has_value());
  EXPECT_THAT(report.characters.at(0).advice,
              Contains(HasSubstr("no message contains all 23 segments")));
}

struct AdviceCase {
  const char* name;
  std::vector<Type> types;
  std::vector<const char*> said;
  bool can_be_shown;
};

class AdviceTest : public InspectionTest, public ::testing::WithParamInterface<AdviceCase> {};

TEST_P(AdviceTest, NamesTheMissingMvnSetting) {
  TypeSet types;
  for (const Type type : GetParam().types) types.set(static_cast<std::size_t>(type));
  SendFrames(0, 100, 1, types);
  const InspectionReport report = Report();
  EXPECT_EQ(report.CanBeShown(), GetParam().can_be_shown);
  ASSERT_EQ(report.characters.size(), 1U);
  for (const char* said : GetParam().said) {
    EXPECT_THAT(report.characters[0].advice, Contains(HasSubstr(said)));
  }
  EXPECT_THAT(report.characters[0].advice, Contains(HasSubstr("switch on Scaling Data")));
  EXPECT_THAT(report.characters[0].advice, Contains(HasSubstr("switch on Character Meta Data")));
}

INSTANTIATE_TEST_SUITE_P(
    Types, AdviceTest,
    ::testing::Values(
        AdviceCase{"only 23",
                   {Type::kTrackers},
                   {"no pose: switch on Position + Orientation (Quaternion)"},
                   false},
        AdviceCase{"only 20",
                   {Type::kJointAngles},
                   {"no pose: switch on Position + Orientation (Quaternion)"},
                   false},
        AdviceCase{"only 21", {Type::kLinear}, {"or Angular Segment Kinematics"}, false},
        AdviceCase{"21 and 22", {Type::kLinear, Type::kAngular}, {}, true},
        AdviceCase{
            "only 02", {Type::kPose}, {"switch on Linear and Angular Segment Kinematics"}, true},
        AdviceCase{"02 and 21",
                   {Type::kPose, Type::kLinear},
                   {"only linear velocities", "switch on Angular Segment Kinematics"},
                   true},
        AdviceCase{"only 01", {Type::kEulerPose}, {"the pose is sent as Euler angles"}, true}));

TEST_F(InspectionTest, ReportsUnityPosesWithTheSettingToSwitchOn) {
  RawDatagram unity;
  unity.type = "05";
  unity.items = 23;
  unity.payload = PoseItems(1, 23);
  for (int i = 0; i < 5; ++i) Send(unity.Bytes());
  const InspectionReport report = Report();
  EXPECT_FALSE(report.CanBeShown());
  ASSERT_EQ(report.errors.size(), 1U);
  EXPECT_THAT(report.errors[0].reason, HasSubstr("switch on Position + Orientation (Quaternion)"));
  EXPECT_THAT(report.characters, IsEmpty());
}

TEST_F(InspectionTest, ReportsAnOldHeader) {
  for (std::uint32_t counter = 0; counter < 10; ++counter) {
    WaitFor(counter);
    RawDatagram old;
    old.counter = counter;
    old.time_code_millis = counter * 1000 / 240;
    old.items = 23;
    old.body_segments = 0;
    old.payload = PoseItems(1, 23);
    old.announced_payload = 0;
    Send(old.Bytes());
  }
  const CharacterReport character = Only();
  EXPECT_TRUE(character.has_old_header);
  EXPECT_EQ(character.samples, 10U);
  EXPECT_THAT(character.advice, Contains(HasSubstr("older than MVN 2018")));
}

TEST_F(InspectionTest, ReportsThatNoDatagramArrived) {
  EXPECT_THAT(Report().advice, ElementsAre(HasSubstr("no datagram")));
  Inspection live(true);
  const InspectionReport report = live.Report(NoTransport(true));
  EXPECT_FALSE(report.CanBeShown());
  EXPECT_THAT(report.advice, ElementsAre(HasSubstr("Network Streamer")));
}

TEST_F(InspectionTest, ReportsTheTransportAndAdviceAboutDrops) {
  SendFrames(0, 10);
  transport_.transport.receive_buffer_bytes = 1 << 20;
  transport_.transport.kernel_drops = 7;
  const InspectionReport report = Report();
  ASSERT_TRUE(report.transport);
  EXPECT_EQ(report.transport->kernel_drops, 7U);
  EXPECT_THAT(report.advice, ElementsAre(HasSubstr("net.core.rmem_max")));
}

TEST_F(InspectionTest, KeepsARealCharacterAmongManyDamagedHeaders) {
  for (int ghost = 0; ghost < 200; ++ghost) {
    RawDatagram datagram;
    datagram.character = 1 + ghost;
    datagram.items = 23;
    datagram.payload = PoseItems(1, 23);
    Send(datagram.Bytes());
  }
  SendFrames(0, 240);
  const InspectionReport report = Report();
  ASSERT_EQ(report.characters.size(), 1U);
  EXPECT_EQ(report.characters[0].id, 0);
  EXPECT_EQ(report.characters[0].samples, 241U);
  EXPECT_EQ(report.datagrams_not_kept, 200U);
  EXPECT_EQ(report.characters[0].datagrams + 200, report.datagrams) << "each is somewhere";
}

TEST_F(InspectionTest, CountsCharactersBeyondSixtyFourWithoutKeepingThem) {
  for (int character = 0; character < 70; ++character) {
    for (std::uint32_t counter = 0; counter < 3; ++counter) {
      now_ = character * kNanosPerMilli + DueNanos(counter);
      Send(Frame(counter, MakeTypeSet({Type::kPose}), character));
    }
  }
  const InspectionReport report = Report();
  EXPECT_EQ(report.characters.size(), Inspection::kMaxCharacters);
  EXPECT_EQ(report.datagrams_not_kept, 6U * 3);
}

TEST_F(InspectionTest, CompletesSamplesOfLiveStreamsByTime) {
  Inspection live(true);
  for (const std::int64_t at : {0, 1}) {
    const auto frame = Frame(static_cast<std::uint32_t>(1 + at), MakeTypeSet({Type::kPose}));
    live.OnDatagram(
        {Suit(),
         {},
         frame[0],
         {kStartMonotonic + at * 5 * kNanosPerMilli, kStartWall + at * 5 * kNanosPerMilli}});
  }
  live.Expire(kStartMonotonic + 10'000 * kNanosPerMilli);
  const InspectionReport report = live.Report(NoTransport(true));
  ASSERT_EQ(report.characters.size(), 1U);
  EXPECT_EQ(report.characters[0].samples, 2U);
}

TEST(Inspection, ReportsThatRecordedTrackersCannotBeShown) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp23_lowerbody_000-149.bin");
  const std::string path = SharedData("udp/mxtp23_lowerbody_000-149.bin");

  const auto source = OpenDatagrams(path);
  Inspection inspection(source->is_live());
  while (source->Poll(std::chrono::nanoseconds(0), inspection) != DatagramSource::State::kEnded) {
  }
  const InspectionReport report = inspection.Report(*source);
  EXPECT_FALSE(report.CanBeShown());
  EXPECT_FALSE(report.has_arrival_times);
  ASSERT_EQ(report.characters.size(), 1U);
  const CharacterReport& character = report.characters[0];
  EXPECT_EQ(character.frames, 150U);
  EXPECT_FALSE(character.lost.has_value()) << "its counter grows by 1 to 10, as it likes";
  EXPECT_EQ(character.smallest_step, 1U);
  EXPECT_EQ(character.largest_step, 10U);
  EXPECT_NEAR(character.capture_rate_hz, 100, 0.01);
  EXPECT_FALSE(character.delays.has_value()) << "a file of datagrams has no times of arrival";
  EXPECT_EQ(OfType(character, 23).most_items, 7);
  EXPECT_THAT(character.advice, Contains(HasSubstr("no pose")));
}

TEST(SampleInspection, ReportsTheContentOfASourceWithoutDatagrams) {
  const auto subject = subject::OpenSubject("lift", 120, 0);
  SampleInspection inspection;
  for (int i = 0; i < 240; ++i) {
    ASSERT_NE(subject->Poll(std::chrono::milliseconds(0), inspection), Source::State::kEnded);
  }
  const InspectionReport report = inspection.Report(*subject);
  EXPECT_TRUE(report.CanBeShown());
  EXPECT_FALSE(report.has_datagrams);
  ASSERT_EQ(report.characters.size(), 1U);
  const CharacterReport& character = report.characters[0];
  EXPECT_GE(character.samples, 240U);
  EXPECT_EQ(character.frames, character.samples);
  EXPECT_NEAR(character.rate_hz, 120, 0.01);
  EXPECT_EQ(character.lost, 0U);
  EXPECT_TRUE(character.height_m);
  EXPECT_EQ(character.quantities.at("velocity"), character.samples);
  EXPECT_NEAR(report.secs, static_cast<double>(character.samples - 1) / 120, 1e-6);
}

TEST(DurationHistogram, IsAccurateToThreePercentOverSixDecades) {
  RandomValues random(5);
  DurationHistogram histogram;
  std::vector<std::int64_t> durations;
  for (int i = 0; i < 20'000; ++i) {
    const double decades = std::uniform_real_distribution<double>(3, 10)(random.engine());
    durations.push_back(std::llround(std::pow(10, decades)));
    histogram.Add(durations.back());
  }
  std::sort(durations.begin(), durations.end());
  for (const double fraction : {0.01, 0.5, 0.95, 0.99, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * 20'000)) - 1;
    const auto exact = static_cast<double>(durations[rank]);
    EXPECT_NEAR(static_cast<double>(histogram.PercentileNanos(fraction)), exact, 0.03 * exact)
        << fraction;
  }
  EXPECT_EQ(histogram.longest_nanos(), durations.back());
  EXPECT_EQ(DurationHistogram().PercentileNanos(0.5), 0);
}

}  // namespace
}  // namespace kinescope::mvn
