#include "server/mvn/datagram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "server/mvn/encode.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using testing::FromHex;
using testing::Items;
using testing::PoseItems;
using testing::RandomSample;
using testing::RandomValues;
using testing::RawDatagram;

template <class Content>
Content Parsed(const std::string& datagram) {
  const auto message = ParseDatagram(datagram);
  if (!message) {
    ADD_FAILURE() << Describe(message.error());
    return {};
  }
  const auto* content = std::get_if<Content>(&message->body);
  if (content == nullptr) {
    ADD_FAILURE() << "parsed to another type than expected";
    return {};
  }
  return *content;
}

// "" when `datagram` is accepted.
std::string ReasonOf(const std::string& datagram) {
  const auto message = ParseDatagram(datagram);
  return message ? "" : Text(message.error().reason);
}

// One good datagram of every type, as a current MVN sends it.
std::vector<std::string> EveryType() {
  RandomValues random(1);
  std::vector<std::string> datagrams = EncodeSample(RandomSample(random, 7));
  Character character;
  character.name = "Ines";
  character.color_rgb = 0x3C78A0;
  character.skeleton = urdf::DefaultSkeleton();
  for (std::string& datagram : EncodeCharacter(character)) datagrams.push_back(std::move(datagram));
  RawDatagram raw;
  raw.items = 23;
  raw.type = "01";
  raw.payload = Items(1, 23, 6, 1);
  datagrams.push_back(raw.Bytes());
  raw.type = "03";
  raw.payload = Items(257, 23, 3, 1);
  datagrams.push_back(raw.Bytes());
  raw.type = "23";
  raw.items = 17;
  raw.payload = Items(1, 17, 16, 1, 0);
  datagrams.push_back(raw.Bytes());
  raw.type = "25";
  raw.items = 1;
  raw.payload = FromHex("0000000c") + "08:30:12.250";
  datagrams.push_back(raw.Bytes());
  return datagrams;
}

TEST(Datagram, RejectsEveryTruncationOfEveryTypeWithItsPlace) {
  std::set<std::string> types;
  for (const std::string& whole : EveryType()) {
    types.insert(whole.substr(4, 2));
    EXPECT_EQ(ReasonOf(whole), "") << "type " << whole.substr(4, 2);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto result = ParseDatagram(std::string_view(whole).substr(0, size));
      ASSERT_FALSE(result) << "type " << whole.substr(4, 2) << ": took " << size << " of "
                           << whole.size() << " bytes for a whole datagram";
      EXPECT_LE(result.error().offset, size);
    }
  }
  EXPECT_THAT(types, ::testing::ElementsAre("01", "02", "03", "12", "13", "20", "21", "22", "23",
                                            "24", "25"));
}

TEST(Datagram, ReadsAnyBytesWithoutReadingBeyondThem) {
  RandomValues random(2);
  for (const std::string& whole : EveryType()) {
    for (int round = 0; round < 300; ++round) {
      std::string changed = whole;
      for (int i = random.Integer(1, 4); i > 0; --i) {
        const int at = random.Integer(0, static_cast<int>(changed.size()) - 1);
        changed[static_cast<std::size_t>(at)] = static_cast<char>(random.Integer(0, 255));
      }
      // Nothing to compare with: the sanitizers judge, and the offset stays inside.
      const auto result = ParseDatagram(changed);
      EXPECT_LE(result ? 0 : result.error().offset, changed.size());
    }
  }
}

TEST(Datagram, ReadsTheHeader) {
  const auto message = ParseDatagram(
      FromHex("4d5854503032 00001092 81 01 0000450b 03 17 02 28 0000 0020"
              "00000001 bfc00000 3e800000 3f800000 00000000 3f800000 00000000 00000000"));
  ASSERT_TRUE(message) << Describe(message.error());
  EXPECT_EQ(message->header.type, Type::kPose);
  EXPECT_EQ(message->header.sample_counter, 4242U);
  EXPECT_EQ(message->header.part, 1);
  EXPECT_TRUE(message->header.is_last_part);
  EXPECT_EQ(message->header.item_count, 1);
  EXPECT_EQ(message->header.time_code_millis, 17675U);
  EXPECT_EQ(message->header.character, 3);
  EXPECT_EQ(message->header.body_segments, 23);
  EXPECT_EQ(message->header.props, 2);
  EXPECT_EQ(message->header.finger_segments, 40);
  EXPECT_EQ(message->header.payload_bytes, 32);
}

TEST(Datagram, ReadsPosesInMetresWithQuaternionsScalarFirst) {
  const auto pose = Parsed<PoseMessage>(
      FromHex("4d5854503032 00001092 80 02 0000450b 00 17 00 00 0000 0040"
              "00000005 bfa00000 3e000000 3fa00000 00000000 00000000 00000000 3f800000"
              "0000000d bfa00000 3ec00000 3fc00000 3f3504f3 bf3504f3 00000000 00000000"));
  EXPECT_EQ(pose.present.count(), 2U);
  ASSERT_TRUE(pose.present.test(urdf::kLeftUpperArm));
  const PoseItem& arm = pose.items[urdf::kLeftUpperArm];
  EXPECT_EQ(arm.position, Eigen::Vector3d(-1.25, 0.375, 1.5));
  // Identity is the T-pose: turned by -90 degrees about x, the left arm, along y, points down.
  const Eigen::Vector3d direction = arm.orientation * Eigen::Vector3d::UnitY();
  EXPECT_TRUE(direction.isApprox(-Eigen::Vector3d::UnitZ(), 1e-6)) << direction;
}

TEST(Datagram, FindsJointsByTheirPairOfPoints) {
  const auto angles = Parsed<JointAnglesMessage>(  // left knee, C1Head, T8_Head: out of order
      FromHex("4d5854503230 00001092 80 03 0000450b 00 17 00 00 0000 003c"
              "00001402 00001501 3fc00000 c0000000 427e0000"
              "00000602 00000701 c0800000 41400000 41040000"
              "00000500 00000700 c0400000 41a00000 41880000"));
  EXPECT_EQ(angles.joints_present.count(), 2U);
  EXPECT_EQ(angles.joints[urdf::jLeftKnee], Eigen::Vector3d(1.5, -2, 63.5));
  EXPECT_EQ(angles.joints[urdf::jC1Head], Eigen::Vector3d(-4, 12, 8.25));
  EXPECT_EQ(angles.ergonomic[kT8Head], Eigen::Vector3d(-3, 20, 17));
  EXPECT_EQ(angles.ergonomic_present.count(), 1U);
}

TEST(Datagram, DistinguishesJointsWithEqualIdsByTheirPosition) {
  for (const std::size_t ergonomic : {0U, 4U, 6U}) {
    Message message;
    JointAnglesMessage body;
    body.joints_present.set();
    for (std::size_t i = 0; i < body.joints.size(); ++i) body.joints[i].setConstant(i + 1.0);
    for (std::size_t i = 0; i < ergonomic; ++i) {
      body.ergonomic_present.set(i);
      body.ergonomic[i].setConstant(100.0 + static_cast<double>(i));
    }
    message.body = body;
    const auto back = Parsed<JointAnglesMessage>(Encode(message));
    EXPECT_TRUE(back.joints_present.all());
    EXPECT_EQ(back.joints, body.joints);
    EXPECT_EQ(back.ergonomic_present, body.ergonomic_present);
    EXPECT_EQ(back.ergonomic, body.ergonomic) << "items 26 and 28 have the same pair of ids";
  }
  EXPECT_EQ(PointsOf(kPelvisT8).parent, PointsOf(kVerticalT8).parent);
  EXPECT_EQ(PointsOf(kPelvisT8).child, PointsOf(kVerticalT8).child);
}

TEST(Datagram, HasThePointsOfEveryJoint) {
  // Parent and child points as MVN numbers them: 256 * segment + point.
  constexpr std::array<std::array<std::uint32_t, 2>, urdf::kJointCount> kPoints = {{
      {0x102, 0x201},   {0x202, 0x301},   {0x302, 0x401},   {0x402, 0x501},  {0x502, 0x601},
      {0x602, 0x701},   {0x503, 0x801},   {0x802, 0x901},   {0x902, 0xa01},  {0xa02, 0xb01},
      {0x504, 0xc01},   {0xc02, 0xd01},   {0xd02, 0xe01},   {0xe02, 0xf01},  {0x103, 0x1001},
      {0x1002, 0x1101}, {0x1102, 0x1201}, {0x1202, 0x1301}, {0x104, 0x1401}, {0x1402, 0x1501},
      {0x1502, 0x1601}, {0x1602, 0x1701},
  }};
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const PointPair points = PointsOf(static_cast<urdf::Joint>(joint));
    EXPECT_EQ(points.parent, kPoints[static_cast<std::size_t>(joint)][0]) << "joint " << joint;
    EXPECT_EQ(points.child, kPoints[static_cast<std::size_t>(joint)][1]) << "joint " << joint;
  }
}

TEST(Datagram, ReadsLinearAndAngularKinematics) {
  const auto linear =
      Parsed<LinearMessage>(FromHex("4d5854503231 00001092 80 01 0000450b 00 17 00 00 0000 0028"
                                    "00000007 3f000000 40000000 3fe00000"
                                    "be800000 3f400000 3e000000 40400000 c0c00000 41100000"));
  EXPECT_EQ(linear.items[urdf::kHead].position, Eigen::Vector3d(0.5, 2, 1.75));
  EXPECT_EQ(linear.items[urdf::kHead].velocity, Eigen::Vector3d(-0.25, 0.75, 0.125));
  EXPECT_EQ(linear.items[urdf::kHead].acceleration, Eigen::Vector3d(3, -6, 9));
  const auto angular =
      Parsed<AngularMessage>(FromHex("4d5854503232 00001092 80 01 0000450b 00 17 00 00 0000 002c"
                                     "00000007 00000000 00000000 00000000 3f800000"
                                     "3f000000 bfa00000 40000000 c1000000 41800000 3f000000"));
  EXPECT_EQ(angular.items[urdf::kHead].orientation.z(), 1);
  EXPECT_EQ(angular.items[urdf::kHead].velocity, Eigen::Vector3d(0.5, -1.25, 2));
  EXPECT_EQ(angular.items[urdf::kHead].acceleration, Eigen::Vector3d(-8, 16, 0.5));
}

TEST(Datagram, ReadsTheCentreOfMassInBothSizes) {
  RawDatagram raw;
  raw.type = "24";
  raw.payload = FromHex("bf000000 3e800000 3f600000");
  const auto old_form = Parsed<CenterOfMassMessage>(raw.Bytes());
  EXPECT_FALSE(old_form.has_derivatives);
  EXPECT_EQ(old_form.position, Eigen::Vector3d(-0.5, 0.25, 0.875));
  raw.payload += FromHex("3fc00000 00000000 be000000 00000000 40200000 c0e00000");
  const auto new_form = Parsed<CenterOfMassMessage>(raw.Bytes());
  EXPECT_TRUE(new_form.has_derivatives);
  EXPECT_EQ(new_form.velocity, Eigen::Vector3d(1.5, 0, -0.125));
  EXPECT_EQ(new_form.acceleration, Eigen::Vector3d(0, 2.5, -7));
  raw.payload.resize(24);
  EXPECT_EQ(ReasonOf(raw.Bytes()), Text(Reason::kPayloadSize));
}

TEST(Datagram, ReadsMetaDataUpToTheFirstColonAndSkipsUnknownTags) {
  const auto meta = [](const std::string& text) {
    RawDatagram raw;
    raw.type = "12";
    raw.items = 1;
    ByteWriter(raw.payload).WriteText(text);
    return Parsed<MetaDataMessage>(raw.Bytes());
  };
  const auto usual = meta("count:1\nname:Ines: the second\nother:thing\ncolor:3c78a0\n");
  EXPECT_EQ(usual.name, "Ines: the second");
  EXPECT_EQ(usual.color_rgb, 0x3C78A0U);
  EXPECT_EQ(meta("count:1\n").name, std::nullopt) << "a message may hold any of the tags";
  EXPECT_EQ(meta("color:orange\n").color_rgb, std::nullopt);
  EXPECT_EQ(meta("name:a\xFF\x01z").name, "a??z") << "names reach JSON and XML: they must be clean";
  EXPECT_EQ(meta("name:\xC3\xA9").name, "\xC3\xA9");
  EXPECT_EQ(meta("name:" + std::string(5000, 'x')).name->size(), 128U);
}

TEST(Datagram, ReadsScaleDataInParts) {
  const auto segments =
      Parsed<ScaleMessage>(FromHex("4d5854503133 00000000 00 00 00000000 00 17 00 00 0000 0030"
                                   "00000002"
                                   "00000004 4e65636b be800000 00000000 3fc00000"
                                   "00000004 48656164 be800000 00000000 3fd00000"
                                   "00000000"));
  ASSERT_EQ(segments.segments.size(), 2U);
  EXPECT_EQ(segments.segments[1].name, "Head");
  EXPECT_EQ(segments.segments[1].origin_in_world, Eigen::Vector3d(-0.25, 0, 1.625));
  const auto points =
      Parsed<ScaleMessage>(FromHex("4d5854503133 00000000 81 00 00000000 00 17 00 00 0000 002a"
                                   "00000000 00000001 0007 0002"
                                   "0000000a 70546f704f6648656164 00000002"
                                   "3e000000 00000000 3e400000"));
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_EQ(points.points[0].name, "pTopOfHead");
  EXPECT_EQ(points.points[0].segment_id, 7);
  EXPECT_EQ(points.points[0].point_id, 2);
  EXPECT_EQ(points.points[0].flags, 2U);
  EXPECT_EQ(points.points[0].offset, Eigen::Vector3d(0.125, 0, 0.1875));
}

TEST(Datagram, ConvertsEulerPosesToTheAxesAndUnitsOfQuaternionPoses) {
  RawDatagram raw;
  raw.type = "01";
  raw.items = 1;
  // Segment 1 at 50, 95, 10 cm; the three turns one at a time.
  const auto parsed = [&raw](const std::string& degrees) {
    raw.payload = FromHex("00000001 42480000 42be0000 41200000" + degrees);
    return Parsed<EulerPoseMessage>(raw.Bytes());
  };
  const auto about_x = parsed("42b40000 00000000 00000000");  // 90 degrees each
  EXPECT_TRUE(about_x.items[0].position.isApprox(Eigen::Vector3d(0.1, 0.5, 0.95), 1e-6));
  const auto turns = [](const EulerPoseMessage& pose, const Eigen::Vector3d& axis) {
    const Eigen::AngleAxisd turn(pose.items[0].orientation);
    return turn.axis().isApprox(axis, 1e-6) && std::abs(turn.angle() - M_PI / 2) < 1e-6;
  };
  EXPECT_TRUE(turns(about_x, Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(turns(parsed("00000000 42b40000 00000000"), Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(turns(parsed("00000000 00000000 42b40000"), Eigen::Vector3d::UnitX()));
}

TEST(Datagram, ReadsVirtualMarkersInMetres) {
  RawDatagram raw;
  raw.type = "03";
  raw.items = 1;
  raw.payload = FromHex("0000010d 42480000 42be0000 41200000");  // pSacrum: segment 1, point 13
  const auto markers = Parsed<MarkersMessage>(raw.Bytes());
  ASSERT_EQ(markers.count, 1);
  EXPECT_EQ(markers.markers[0].segment_id, 1U);
  EXPECT_EQ(markers.markers[0].point_id, 13U);
  EXPECT_TRUE(markers.markers[0].position.isApprox(Eigen::Vector3d(0.1, 0.5, 0.95), 1e-6));
}

TEST(Datagram, ReadsTrackersInBothSizes) {
  RawDatagram raw;
  raw.type = "23";
  raw.items = 2;
  ByteWriter out(raw.payload);
  const auto write = [&out](std::uint32_t id, int numbers) {
    out.Write(id);
    for (const double part : {0.0, 1.0, 0.0, 0.0}) out.WriteFloat(part);  // w x y z
    for (int i = 0; i < numbers; ++i) out.WriteFloat(i);
  };
  write(5, 12);
  write(24, 12);  // a tracker on a prop
  const auto whole = Parsed<TrackersMessage>(raw.Bytes());
  EXPECT_EQ(whole.present.count(), 1U);
  EXPECT_EQ(whole.skipped, 1);
  const TrackerState& tracker = whole.trackers[urdf::kT8];
  EXPECT_TRUE(tracker.has_rates);
  EXPECT_EQ(tracker.orientation.coeffs(), Eigen::Vector4d(1, 0, 0, 0));
  EXPECT_EQ(tracker.free_acceleration, Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(tracker.acceleration, Eigen::Vector3d(3, 4, 5));
  EXPECT_EQ(tracker.angular_velocity, Eigen::Vector3d(6, 7, 8));
  EXPECT_EQ(tracker.magnetic_field, Eigen::Vector3d(9, 10, 11));

  raw.payload.clear();
  write(5, 6);
  write(7, 6);
  const auto old = Parsed<TrackersMessage>(raw.Bytes());
  ASSERT_TRUE(old.present.test(urdf::kT8));
  EXPECT_FALSE(old.trackers[urdf::kT8].has_rates);
  EXPECT_EQ(old.trackers[urdf::kT8].magnetic_field, Eigen::Vector3d(3, 4, 5));
}

TEST(Datagram, ReadsTheTimeOfDayInEveryEncoding) {
  RawDatagram raw;
  raw.type = "25";
  const auto millis = [&raw](const std::string& payload) {
    raw.payload = payload;
    return Parsed<TimeCodeMessage>(raw.Bytes()).utc_millis_of_day;
  };
  constexpr int kSeconds = (8 * 60 + 30) * 60 + 12;
  EXPECT_EQ(millis(FromHex("0000000c") + "08:30:12.250"), kSeconds * 1000 + 250);
  EXPECT_EQ(millis(FromHex("00000008") + "08:30:12"), kSeconds * 1000);
  EXPECT_EQ(millis("08:30:12.250"), kSeconds * 1000 + 250);
  EXPECT_EQ(millis("08:30:12.5"), kSeconds * 1000 + 500);
  EXPECT_EQ(millis("00:00:00"), 0);
  raw.payload = FromHex("0000000c") + "08:30:12.250";
  raw.announced_payload = 12;  // as a sender that forgets the length's own four bytes
  EXPECT_EQ(Parsed<TimeCodeMessage>(raw.Bytes()).utc_millis_of_day, kSeconds * 1000);
  raw.announced_payload = -1;
  for (const std::string wrong : {"24:00:00", "08:60:00", "08-30-12", "08:30:12,250", "ab:cd:ef"}) {
    raw.payload = FromHex("0000000c") + wrong;
    EXPECT_EQ(ReasonOf(raw.Bytes()), Text(Reason::kTimeOfDay)) << wrong;
  }
}

TEST(Datagram, ReportsLegacyTypesByNameWithTheSettingToSwitchOn) {
  for (const std::string type : {"04", "05", "10", "11"}) {
    RawDatagram raw;
    raw.type = type;
    raw.items = 1;
    raw.payload = PoseItems(1, 1);
    EXPECT_THAT(ReasonOf(raw.Bytes()), ::testing::StartsWith("type " + type));
    EXPECT_THAT(ReasonOf(raw.Bytes()), ::testing::HasSubstr("switch on"));
  }
}

TEST(Datagram, ReportsASeparateReasonForEachFault) {
  RawDatagram pose;
  pose.items = 2;
  pose.payload = PoseItems(1, 2);
  ASSERT_EQ(ReasonOf(pose.Bytes()), "");

  EXPECT_EQ(ReasonOf(""), Text(Reason::kEmpty));
  EXPECT_EQ(ReasonOf(R"( {"sync":"start"})"), Text(Reason::kJsonText));
  EXPECT_EQ(ReasonOf("<CaptureStart/>"), Text(Reason::kXmlText));
  EXPECT_EQ(ReasonOf("GET / HTTP/1.0\r\n"), Text(Reason::kForeignText));
  EXPECT_EQ(ReasonOf(std::string(40, '\x7F')), Text(Reason::kForeign));
  EXPECT_EQ(ReasonOf("MXTP02"), Text(Reason::kShortHeader));

  RawDatagram changed = pose;
  changed.type = "99";
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kUnknownType));
  changed.type = "0x";
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kUnknownType));

  changed = pose;
  changed.announced_payload = 65;
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kShortPayload));
  for (const int lie : {1, 3, 255}) {
    changed = pose;
    changed.items = lie;
    EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kItemCount)) << lie << " items announced";
  }
  changed = pose;
  changed.payload = Items(0, 2, 7, 0.5, 3);
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kIdZero));
  changed.payload = PoseItems(4, 1) + PoseItems(4, 1);
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kRepeatedId));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    changed.payload = Items(1, 2, 7, bad, 3);
    EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kNotFinite));
  }
  changed.payload = Items(1, 2, 7, 1e30, 3);
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kOutOfRange));
  changed.payload = Items(1, 2, 7, 0.501);  // the norm is 1.002
  EXPECT_EQ(ReasonOf(changed.Bytes()), Text(Reason::kNotUnit));
  changed.payload = Items(1, 2, 7, 0.5004);  // 1.0008: rounding of some sender
  EXPECT_EQ(ReasonOf(changed.Bytes()), "");

  RawDatagram scale;
  scale.type = "13";
  scale.payload = FromHex("7fffffff 00000000");
  EXPECT_EQ(ReasonOf(scale.Bytes()), Text(Reason::kLyingCount));
  scale.payload = FromHex("00000001 ffffffff 00000000 00000000 00000000 00000000");
  EXPECT_EQ(ReasonOf(scale.Bytes()), Text(Reason::kLyingLength));
  scale.type = "12";
  scale.payload = FromHex("00000009") + "name:Ine";
  EXPECT_EQ(ReasonOf(scale.Bytes()), Text(Reason::kLyingLength));
}

TEST(Datagram, HasADifferentTextForEveryReason) {
  std::set<std::string> texts;
  for (int i = 0; i < kReasonCount; ++i) texts.insert(Text(static_cast<Reason>(i)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kReasonCount));
}

TEST(Datagram, AcceptsOldSendersWithoutPayloadSizes) {
  RawDatagram raw;
  raw.items = 23;
  raw.payload = PoseItems(1, 23);
  raw.announced_payload = 0;
  std::string old = raw.Bytes();
  for (const std::size_t byte : {17U, 18U, 19U}) old[byte] = 0;  // one reserved block then
  EXPECT_TRUE(Parsed<PoseMessage>(old).HasBody());
  raw.items = 0;  // and where not even the items are counted
  EXPECT_TRUE(Parsed<PoseMessage>(raw.Bytes()).HasBody());
  EXPECT_EQ(ReasonOf(old.substr(0, old.size() - 1)), Text(Reason::kItemCount));
}

TEST(Datagram, IgnoresBytesAfterThePayload) {
  RawDatagram raw;
  raw.items = 23;
  raw.payload = PoseItems(1, 23);
  raw.announced_payload = static_cast<int>(raw.payload.size());
  EXPECT_TRUE(Parsed<PoseMessage>(raw.Bytes() + "and more").HasBody());
}

TEST(Datagram, AcceptsLongerItemsOfLaterVersions) {
  RawDatagram raw;
  raw.items = 23;
  raw.payload = Items(1, 23, 8, 0.25, 3);  // one float more in each
  EXPECT_TRUE(Parsed<PoseMessage>(raw.Bytes()).HasBody());
}

std::size_t Slot(int extra) { return static_cast<std::size_t>(urdf::kSegmentCount + extra); }

// Items of the ids 1 to `count`, item i at x = i / 100.
std::string NumberedPoses(int count) {
  std::string payload;
  for (int i = 0; i < count; ++i) {
    payload += Items(static_cast<std::uint32_t>(i + 1), 1, 7, i / 128.0, 3);
  }
  return payload;
}

TEST(Datagram, AssignsPropsAndFingersForAnyNumberOfProps) {
  for (int props = 0; props <= kMaxProps; ++props) {
    RawDatagram raw;
    raw.props = props;
    raw.fingers = 40;
    raw.items = 63 + props;
    raw.payload = NumberedPoses(raw.items);
    ASSERT_EQ(raw.Bytes().size(), static_cast<std::size_t>(24 + 32 * raw.items));
    const auto pose = Parsed<PoseMessage>(raw.Bytes());
    EXPECT_EQ(pose.present.count(), static_cast<std::size_t>(raw.items));
    EXPECT_EQ(pose.skipped + pose.mismatched_ids, 0);
    const auto number = [&](int extra) {
      return std::lround(pose.items[Slot(extra)].position.x() * 128);
    };
    for (int prop = 0; prop < props; ++prop) EXPECT_EQ(number(PropIndex(prop)), 23 + prop);
    for (int finger = 0; finger < kFingersPerHand; ++finger) {
      EXPECT_EQ(number(FingerIndex(urdf::kLeft, finger)), 23 + props + finger);
      EXPECT_EQ(number(FingerIndex(urdf::kRight, finger)), 43 + props + finger);
    }
  }
}

TEST(Datagram, AssignsPropsByOrderIfTheirIdsDifferAndReportsIt) {
  RawDatagram raw;
  raw.props = 1;
  raw.items = 24;
  raw.payload = PoseItems(1, 23) + Items(25, 1, 7, 0.5, 3);  // 25, as some senders have it
  const auto pose = Parsed<PoseMessage>(raw.Bytes());
  EXPECT_TRUE(pose.present.test(Slot(PropIndex(0))));
  EXPECT_EQ(pose.mismatched_ids, 1);
}

TEST(Datagram, RecognisesPropsOfAnOldHeaderByTheirId) {
  RawDatagram raw;
  raw.body_segments = 0;
  raw.items = 24;
  raw.payload = PoseItems(1, 24);
  EXPECT_TRUE(Parsed<PoseMessage>(raw.Bytes()).present.test(Slot(PropIndex(0))));
}

TEST(Datagram, SkipsItemsThatItsHeaderDoesNotAnnounce) {
  RawDatagram raw;
  raw.items = 63;
  raw.payload = PoseItems(1, 63);
  const auto gloves = Parsed<PoseMessage>(raw.Bytes());
  EXPECT_TRUE(gloves.HasBody());
  EXPECT_EQ(gloves.skipped, 40);
  raw.props = 255;  // no more than four have a place
  raw.items = 67;
  raw.payload = PoseItems(1, 67);
  EXPECT_EQ(Parsed<PoseMessage>(raw.Bytes()).skipped, 40);
  raw.items = 1;
  raw.payload = PoseItems(0xFFFFFFFF, 1);
  EXPECT_EQ(Parsed<PoseMessage>(raw.Bytes()).skipped, 1);
  raw.type = "20";
  raw.payload = FromHex("00001801 00001901 00000000 00000000 00000000");
  EXPECT_EQ(Parsed<JointAnglesMessage>(raw.Bytes()).skipped, 1);
}

}  // namespace
}  // namespace kinescope::mvn
