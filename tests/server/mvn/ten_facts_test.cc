// The ten facts about the stream that most code gets wrong (mvn-protocol.md, at the top), one test
// each, on bytes built here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "server/mvn/assembler.h"
#include "server/mvn/datagram.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/net/sender.h"
#include "server/mvn/open.h"
#include "tests/server/mvn/mvn_testing.h"
#include "urdf/kinematics.h"

namespace kinescope::mvn {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using testing::PoseItems;
using testing::RawDatagram;
using testing::RecordingSink;

constexpr double kHalfTurnRoot = 0.70710678118654752;  // cos 45 deg

std::string Floats(const std::vector<double>& values) {
  std::string bytes;
  ByteWriter out(bytes);
  for (const double value : values) out.WriteFloat(value);
  return bytes;
}

std::string Word(std::uint32_t value) {
  std::string bytes;
  ByteWriter(bytes).Write(value);
  return bytes;
}

std::string HalfWord(std::uint16_t value) {
  std::string bytes;
  ByteWriter(bytes).Write(value);
  return bytes;
}

std::string SizedText(const std::string& text) {
  return Word(static_cast<std::uint32_t>(text.size())) + text;
}

template <class Content>
Content Parse(const RawDatagram& datagram) {
  const auto message = ParseDatagram(datagram.Bytes());
  if (!message) {
    ADD_FAILURE() << "type " << datagram.type << ": " << Describe(message.error());
    return Content();
  }
  return std::get<Content>(message->body);
}

RawDatagram Datagram(const std::string& type, int items, const std::string& payload) {
  RawDatagram datagram;
  datagram.type = type;
  datagram.items = items;
  datagram.payload = payload;
  return datagram;
}

void ExpectNear(const Eigen::Vector3d& got, const Eigen::Vector3d& wanted, const char* what) {
  EXPECT_LT((got - wanted).norm(), 1e-5) << what << ": " << got.transpose();
}

// The same place in every type: 1 m forward, 0.2 m to the left, 1.5 m up.
TEST(TenFacts, Fact01EulerPosesAndMarkersAreYUpCentimetresAllOthersZUpMetres) {
  const Eigen::Vector3d place(1, 0.2, 1.5);
  const std::string y_up_cm = Floats({20, 150, 100});
  const std::string z_up_m = Floats({1, 0.2, 1.5});
  const std::string nothing = Floats({0, 0, 0});

  const auto euler = Parse<EulerPoseMessage>(Datagram(
      "01", 1, Word(1) + y_up_cm + Floats({0, 90, 0})));  // 90 degrees about the Y that is up
  ExpectNear(euler.items[0].position, place, "01");
  ExpectNear(euler.items[0].orientation * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
             "01 turns to the left");
  const auto markers = Parse<MarkersMessage>(Datagram("03", 1, Word(256 + 13) + y_up_cm));
  ExpectNear(markers.markers[0].position, place, "03");

  const std::string upright = Floats({1, 0, 0, 0});
  const auto pose = Parse<PoseMessage>(Datagram("02", 1, Word(1) + z_up_m + upright));
  ExpectNear(pose.items[0].position, place, "02");
  const auto scale =
      Parse<ScaleMessage>(Datagram("13", 0,
                                   Word(1) + SizedText("Pelvis") + z_up_m + Word(1) + HalfWord(1) +
                                       HalfWord(13) + SizedText("pSacrum") + Word(0) + z_up_m));
  ExpectNear(scale.segments[0].origin_in_world, place, "13, segment");
  ExpectNear(scale.points[0].offset, place, "13, point");
  const auto linear = Parse<LinearMessage>(Datagram("21", 1, Word(1) + z_up_m + z_up_m + z_up_m));
  ExpectNear(linear.items[0].position, place, "21, position");
  ExpectNear(linear.items[0].velocity, place, "21, velocity");
  ExpectNear(linear.items[0].acceleration, place, "21, acceleration");
  const auto angular =
      Parse<AngularMessage>(Datagram("22", 1, Word(1) + upright + z_up_m + z_up_m));
  ExpectNear(angular.items[0].velocity, place, "22, rad/s and not degrees");
  const auto trackers = Parse<TrackersMessage>(
      Datagram("23", 1, Word(1) + upright + z_up_m + z_up_m + z_up_m + z_up_m));
  ExpectNear(trackers.trackers[0].free_acceleration, place, "23");
  const auto com = Parse<CenterOfMassMessage>(Datagram("24", 1, z_up_m + nothing + nothing));
  ExpectNear(com.position, place, "24");
}

TEST(TenFacts, Fact02CentreOfMassHas36BytesAndTimeCode16) {
  const RawDatagram com = Datagram("24", 1, Floats({1, 2, 3, 4, 5, 6, 7, 8, 9}));
  ASSERT_EQ(com.payload.size(), 36U);
  const auto whole = Parse<CenterOfMassMessage>(com);
  EXPECT_TRUE(whole.has_derivatives);
  ExpectNear(whole.velocity, {4, 5, 6}, "velocity");
  ExpectNear(whole.acceleration, {7, 8, 9}, "acceleration");
  const auto old = Parse<CenterOfMassMessage>(Datagram("24", 1, Floats({1, 2, 3})));
  EXPECT_FALSE(old.has_derivatives) << "the 12 bytes of the specification: position only";

  const RawDatagram time = Datagram("25", 1, SizedText("15:59:46.065"));
  ASSERT_EQ(time.payload.size(), 16U);
  EXPECT_EQ(Parse<TimeCodeMessage>(time).utc_millis_of_day, ((15 * 60 + 59) * 60 + 46) * 1000 + 65);
}

TEST(TenFacts, Fact03TrackersHave68BytesEach) {
  const auto tracker = [](std::uint32_t id, bool is_whole) {
    std::string item = Word(id) + Floats({1, 0, 0, 0, 0.1, 0.2, 0.3});
    if (is_whole) item += Floats({0, 0, 9.81, 1, 2, 3});
    return item + Floats({0.6, 0, -0.8});
  };
  const RawDatagram now = Datagram("23", 2, tracker(5, true) + tracker(18, true));
  ASSERT_EQ(now.payload.size(), 2U * 68);
  const auto whole = Parse<TrackersMessage>(now);
  EXPECT_EQ(whole.present.count(), 2U);
  const TrackerState& foot = whole.trackers[urdf::kRightFoot];
  EXPECT_TRUE(foot.has_rates);
  ExpectNear(foot.acceleration, {0, 0, 9.81}, "acceleration");
  ExpectNear(foot.angular_velocity, {1, 2, 3}, "angular velocity");
  ExpectNear(foot.magnetic_field, {0.6, 0, -0.8}, "magnetic field");

  const RawDatagram other = Datagram("23", 2, tracker(5, false) + tracker(18, false));
  ASSERT_EQ(other.payload.size(), 2U * 44) << "as one section of the specification has it";
  const auto without = Parse<TrackersMessage>(other);
  EXPECT_FALSE(without.trackers[urdf::kRightFoot].has_rates);
  ExpectNear(without.trackers[urdf::kRightFoot].magnetic_field, {0.6, 0, -0.8}, "magnetic field");
}

// A suit that captures at 240 Hz and sends at 60.
TEST(TenFacts, Fact04TheSampleCounterCountsCapturedFramesSoGapsAreNormal) {
  Assembler assembler;
  RecordingSink sink;
  constexpr int kSamples = 40;
  std::int64_t now = 1'000'000'000;
  for (int i = 0; i < kSamples; ++i) {
    RawDatagram pose = Datagram("02", 23, PoseItems(1, 23));
    pose.counter = 1000 + 4 * static_cast<std::uint32_t>(i);
    pose.time_code_millis = pose.counter * 1000 / 240;
    assembler.Add({}, pose.Bytes(), {now, now}, sink);
    now += 1'000'000'000 / 60;
    assembler.Expire(now, sink);
  }
  assembler.Flush(sink);
  EXPECT_EQ(sink.samples.size(), static_cast<std::size_t>(kSamples));
  EXPECT_EQ(assembler.counters().counter_gaps, 0U) << "a step of 4 every time is no loss";
  EXPECT_EQ(assembler.counters().incomplete, 0U);
}

// Poses of body, props and both gloves, in one datagram.
RawDatagram PoseWithEverything(int props) {
  RawDatagram pose;
  pose.items = 23 + props + 40;
  pose.props = props;
  pose.fingers = 40;
  pose.payload = PoseItems(1, pose.items);
  return pose;
}

TEST(TenFacts, Fact05APoseWithGlovesIsOneLongDatagramThatIsReceivedCompletely) {
  EXPECT_EQ(PoseWithEverything(0).Bytes().size(), 2040U);
  EXPECT_EQ(PoseWithEverything(1).Bytes().size(), 2072U) << "more than 2048";
  EXPECT_EQ(PoseWithEverything(4).Bytes().size(), 2168U);

  struct Sink : DatagramSink {
    std::vector<std::string> datagrams;
    void OnDatagram(const ReceivedDatagram& datagram) override {
      datagrams.emplace_back(datagram.bytes);
    }
  } sink;
  const auto receiver = OpenDatagrams("udp://127.0.0.1:0");
  const auto sender = OpenSender(receiver->description());
  for (const int props : {0, 1, 4}) sender->Send(PoseWithEverything(props).Bytes());
  for (int tries = 0; tries < 100 && sink.datagrams.size() < 3; ++tries) {
    ASSERT_NE(receiver->Poll(std::chrono::milliseconds(100), sink), DatagramSource::State::kEnded);
  }
  ASSERT_EQ(sink.datagrams.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<int, 3> props = {0, 1, 4};
    const auto message = ParseDatagram(sink.datagrams[i]);
    ASSERT_TRUE(message) << Describe(message.error());
    EXPECT_EQ(std::get<PoseMessage>(message->body).present.count(),
              static_cast<std::size_t>(23 + props[i] + 40));
  }
}

TEST(TenFacts, Fact06TheNumberOfItemsIsUnusedIn12And13And24And25) {
  const std::string scale = Word(1) + SizedText("Pelvis") + Floats({0, 0, 1}) + Word(0);
  for (const int items : {0, 1, 7, 255}) {
    EXPECT_EQ(Parse<MetaDataMessage>(Datagram("12", items, SizedText("name:Anna\n"))).name, "Anna");
    EXPECT_EQ(Parse<ScaleMessage>(Datagram("13", items, scale)).segments.size(), 1U);
    EXPECT_TRUE(
        Parse<CenterOfMassMessage>(Datagram("24", items, Floats({1, 2, 3, 4, 5, 6, 7, 8, 9})))
            .has_derivatives);
    EXPECT_EQ(
        Parse<TimeCodeMessage>(Datagram("25", items, SizedText("00:00:01.000"))).utc_millis_of_day,
        1000);
  }
}

TEST(TenFacts, Fact07JointItems26And28HaveEqualIdsAndDifferByPosition) {
  const std::uint32_t pelvis = 0x0100;
  const std::uint32_t t8 = 0x0500;
  const std::string twenty_sixth = Word(pelvis) + Word(t8) + Floats({26, 0, 0});
  const std::string twenty_seventh = Word(pelvis) + Word(pelvis) + Floats({27, 0, 0});
  const std::string twenty_eighth = Word(pelvis) + Word(t8) + Floats({28, 0, 0});
  const auto both =
      Parse<JointAnglesMessage>(Datagram("20", 3, twenty_sixth + twenty_seventh + twenty_eighth));
  EXPECT_EQ(both.ergonomic[kPelvisT8].x(), 26);
  EXPECT_EQ(both.ergonomic[kVerticalPelvis].x(), 27);
  EXPECT_EQ(both.ergonomic[kVerticalT8].x(), 28);
  const auto old = Parse<JointAnglesMessage>(Datagram("20", 1, twenty_sixth));
  EXPECT_EQ(old.ergonomic[kPelvisT8].x(), 26);
  EXPECT_FALSE(old.ergonomic_present.test(kVerticalT8)) << "MVN before 2019.1 has only the first";
}

TEST(TenFacts, Fact08ForeignTextAndASecondCharacterShareThePort) {
  Assembler assembler;
  RecordingSink sink;
  std::int64_t now = 1'000'000'000;
  for (std::uint32_t counter = 1; counter <= 10; ++counter) {
    for (const int character : {0, 1}) {
      RawDatagram pose = Datagram("02", 23, PoseItems(1, 23));
      pose.counter = counter;
      pose.time_code_millis = counter * 10;
      pose.character = character;
      assembler.Add({}, pose.Bytes(), {now, now}, sink);
    }
    for (const char* text : {R"({"type":"transport","value":"record"})",
                             "<CaptureStart><Name VALUE=\"x\"/></CaptureStart>", "hello"}) {
      assembler.Add({}, text, {now, now}, sink);
    }
    now += 10'000'000;
    assembler.Expire(now, sink);
  }
  assembler.Flush(sink);
  std::array<int, 2> samples{};
  for (const BodySample& sample : sink.samples)
    ++samples.at(static_cast<std::size_t>(sample.character));
  EXPECT_THAT(samples, ElementsAre(10, 10));
  EXPECT_THAT(assembler.counters().rejected,
              ElementsAre(Pair(Text(Reason::kJsonText), 10), Pair(Text(Reason::kXmlText), 10),
                          Pair(Text(Reason::kForeignText), 10)));
  EXPECT_EQ(assembler.counters().restarts, 0U) << "the characters do not disturb each other";
}

TEST(TenFacts, Fact09IdsOfFingersDependOnTheNumberOfProps) {
  for (int props = 0; props <= kMaxProps; ++props) {
    // Only the first finger of each hand and the props, so that ids decide and not the order.
    RawDatagram pose;
    pose.props = props;
    pose.fingers = 40;
    const auto first_finger = static_cast<std::uint32_t>(24 + props);
    pose.payload = PoseItems(24, props + 1) + PoseItems(first_finger + 20, 1);
    pose.items = props + 2;
    const auto message = Parse<PoseMessage>(pose);
    const auto has = [&](int extra) {
      return message.present.test(static_cast<std::size_t>(urdf::kSegmentCount + extra));
    };
    EXPECT_EQ(message.present.count(), static_cast<std::size_t>(props) + 2);
    EXPECT_TRUE(has(FingerIndex(urdf::kLeft, 0))) << "left carpus with " << props << " props";
    EXPECT_TRUE(has(FingerIndex(urdf::kRight, 0))) << "right carpus with " << props << " props";
    for (int prop = 0; prop < props; ++prop) EXPECT_TRUE(has(PropIndex(prop)));
  }
}

// A person in the T-pose: every segment frame is identity, and yet shoulders and elbows are turned.
TEST(TenFacts, Fact10SegmentFramesAreIdentityInTheTPoseAndJointAnglesAreNot) {
  Assembler assembler;
  RecordingSink sink;
  RawDatagram pose = Datagram("02", 23, PoseItems(1, 23));
  // What MVN says of it: arms 90 degrees away from the body, forearms turned in by 90.
  RawDatagram joints = Datagram("20", urdf::kJointCount, "");
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const bool is_shoulder = joint == urdf::jRightShoulder || joint == urdf::jLeftShoulder;
    const bool is_elbow = joint == urdf::jRightElbow || joint == urdf::jLeftElbow;
    const PointPair points = PointsOf(static_cast<urdf::Joint>(joint));
    joints.payload += Word(points.parent) + Word(points.child) +
                      Floats({is_shoulder ? 90.0 : 0.0, is_elbow ? 90.0 : 0.0, 0});
  }
  assembler.Add({}, pose.Bytes(), {1, 1}, sink);
  assembler.Add({}, joints.Bytes(), {1, 1}, sink);
  assembler.Flush(sink);
  ASSERT_EQ(sink.samples.size(), 1U);
  const BodySample& sample = sink.samples[0];
  for (const SegmentState& segment : sample.segments) {
    EXPECT_LT(segment.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  }

  // MVN's own (x, y, z) of a joint, from the poses turned into the frames that its angles are about
  // (mvn-protocol.md 4.5): x away from the body, y inwards, z flexion.
  const auto degrees = [&](urdf::Joint joint, double side) -> Eigen::Vector3d {
    const int parent = urdf::ParentOf(joint);
    const int child = urdf::ChildOf(joint);
    const Eigen::Quaterniond turn =
        (sample.segments[urdf::At(parent)].orientation * urdf::SegmentFromIsb(parent)).conjugate() *
        (sample.segments[urdf::At(child)].orientation * urdf::SegmentFromIsb(child));
    const Eigen::Vector3d cardan = urdf::AnglesFromRotation(turn);  // alpha, -gamma, beta
    return Eigen::Vector3d(side * cardan.x(), -side * cardan.z(), -cardan.y()) * 180 / M_PI;
  };
  ASSERT_TRUE(sample.streamed_angles_deg.has_value());
  for (const urdf::Joint joint : {urdf::jRightShoulder, urdf::jRightElbow, urdf::jRightWrist,
                                  urdf::jLeftShoulder, urdf::jLeftElbow, urdf::jLeftWrist}) {
    const bool is_left = joint >= urdf::jLeftC7Shoulder;
    ExpectNear(degrees(joint, is_left ? 1 : -1), (*sample.streamed_angles_deg)[urdf::At(joint)],
               urdf::kJoints[urdf::At(joint)].label.data());
  }
  // And in the frames of our links, which hang in identity, the arm is raised by 90 degrees.
  EXPECT_NEAR(
      urdf::SegmentFromLink(urdf::kRightUpperArm).angularDistance(Eigen::Quaterniond::Identity()),
      2 * std::acos(kHalfTurnRoot), 1e-9);
}

}  // namespace
}  // namespace kinescope::mvn
