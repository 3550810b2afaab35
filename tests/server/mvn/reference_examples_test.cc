// Our decoder against another one, written apart from it in another language, on that one's own
// examples. It is not part of this repository: see tests/shared_data.h.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/mvn/datagram.h"
#include "server/mvn/stream_framer.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"

namespace kinescope::mvn {
namespace {

using Json = nlohmann::json;
using ::kinescope::testing::SharedData;
using testing::FromHex;

std::filesystem::path ReferenceFolder() {
  return SharedData("").parent_path().parent_path() / "reference";
}

std::string RunPython(const std::string& program, const std::string& argument) {
  const std::string command = "/usr/bin/python3 -B -c '" + program + "' '" + argument + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(popen(command.c_str(), "r"), &pclose);
  std::string text;
  for (int c = std::fgetc(out.get()); c != EOF; c = std::fgetc(out.get())) {
    text.push_back(static_cast<char>(c));
  }
  return text;
}

class ReferenceExamples : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(ReferenceFolder() / "mvn_example_datagrams.py")) {
      GTEST_SKIP() << "reference decoder " << ReferenceFolder() << " is absent";
    }
    // Each example as bytes, with what the other decoder makes of it; and all of them as a stream.
    const std::string text = RunPython(
        "import sys, json; sys.path.insert(0, sys.argv[1]); import mvn_example_datagrams as m\n"
        "raw = {name: m.raw(example) for name, example in m.EXAMPLES.items()}\n"
        "raw.update({\"seen_\" + kind: data for kind, data in "
        "((k, bytes.fromhex(t)) for k, t in m.SEEN.items())})\n"
        "def decoded(data):\n"
        "  try: return dict(zip((\"head\", \"body\"), m.decode(data)))\n"
        "  except m.Bad: return None\n"
        "stream = b\"junk\".join(m.raw(e) for e in m.EXAMPLES.values())\n"
        "json.dump({\"examples\": {n: {\"hex\": d.hex(), \"decoded\": decoded(d)} "
        "for n, d in raw.items()}, \"stream\": stream.hex(), "
        "\"cut\": [d.hex() for d in m.split_tcp(stream)[0]]}, sys.stdout)",
        ReferenceFolder().string());
    json_ = Json::parse(text, nullptr, false);
    ASSERT_FALSE(json_.is_discarded()) << "the reference decoder said: " << text;
    ASSERT_GE(json_["examples"].size(), 13U);
  }

  Json json_;
};

Eigen::Vector3d VectorAt(const Json& numbers, std::size_t at) {
  return {numbers.at(at).get<double>(), numbers.at(at + 1).get<double>(),
          numbers.at(at + 2).get<double>()};
}

void ExpectSame(const Eigen::Vector3d& got, const Eigen::Vector3d& wanted) {
  EXPECT_LT((got - wanted).norm(), 1e-12) << got.transpose() << " for " << wanted.transpose();
}

// In Json: w x y z, not quite of unit length, as floats are.
void ExpectSame(const Eigen::Quaterniond& got, const Json& numbers, std::size_t at) {
  const Eigen::Vector3d xyz = VectorAt(numbers, at + 1);
  const Eigen::Quaterniond wanted(numbers.at(at).get<double>(), xyz.x(), xyz.y(), xyz.z());
  EXPECT_NEAR(got.dot(wanted.normalized()), 1, 1e-12);
}

std::size_t SlotOf(const Json& item) {
  return item.at(0).at(0).get<std::size_t>() - 1;  // ids of segments are from 1
}

void CompareHeader(const Header& header, const Json& head) {
  EXPECT_EQ(TypeDigits(header.type), head["kind"].get<std::string>());
  EXPECT_EQ(header.sample_counter, head["sample"]);
  EXPECT_EQ(header.part, head["index"]);
  EXPECT_EQ(header.is_last_part, head["last"]);
  EXPECT_EQ(header.item_count, head["items"]);
  EXPECT_EQ(header.time_code_millis, head["time_ms"]);
  EXPECT_EQ(header.character, head["character"]);
  EXPECT_EQ(header.body_segments, head["body"]);
  EXPECT_EQ(header.props, head["props"]);
  EXPECT_EQ(header.finger_segments, head["fingers"]);
  EXPECT_EQ(header.payload_bytes, head["payload"]);
}

// One overload for each type of message, on the other decoder's body.
struct Compare {
  const Json& body;

  void operator()(const PoseMessage& got) const {
    ASSERT_EQ(got.present.count(), body.size());
    for (const Json& item : body) {
      const PoseItem& pose = got.items.at(SlotOf(item));
      EXPECT_TRUE(got.present.test(SlotOf(item)));
      ExpectSame(pose.position, VectorAt(item[1], 0));
      ExpectSame(pose.orientation, item[1], 3);
    }
  }
  void operator()(const EulerPoseMessage& got) const {
    ASSERT_EQ(got.present.count(), body.size());
    Eigen::Matrix3d z_up_from_y_up;  // x left, y up, z forward
    z_up_from_y_up << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    for (const Json& item : body) {
      const PoseItem& pose = got.items.at(SlotOf(item));
      EXPECT_TRUE(got.present.test(SlotOf(item)));
      ExpectSame(pose.position, z_up_from_y_up * VectorAt(item[1], 0) / 100);
      const Eigen::Vector3d angles = VectorAt(item[1], 3) * M_PI / 180;
      const Eigen::Matrix3d turn_in_y_up =
          (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
      const Eigen::Matrix3d wanted = z_up_from_y_up * turn_in_y_up * z_up_from_y_up.transpose();
      EXPECT_LT((pose.orientation.toRotationMatrix() - wanted).norm(), 1e-12);
    }
  }
  void operator()(const LinearMessage& got) const {
    ASSERT_EQ(got.present.count(), body.size());
    for (const Json& item : body) {
      const LinearItem& linear = got.items.at(SlotOf(item));
      ExpectSame(linear.position, VectorAt(item[1], 0));
      ExpectSame(linear.velocity, VectorAt(item[1], 3));
      ExpectSame(linear.acceleration, VectorAt(item[1], 6));
    }
  }
  void operator()(const AngularMessage& got) const {
    ASSERT_EQ(got.present.count(), body.size());
    for (const Json& item : body) {
      const AngularItem& angular = got.items.at(SlotOf(item));
      ExpectSame(angular.orientation, item[1], 0);
      ExpectSame(angular.velocity, VectorAt(item[1], 4));
      ExpectSame(angular.acceleration, VectorAt(item[1], 7));
    }
  }
  void operator()(const TrackersMessage& got) const {
    ASSERT_EQ(got.present.count(), body.size());
    for (const Json& item : body) {
      const TrackerState& tracker = got.trackers.at(SlotOf(item));
      EXPECT_TRUE(tracker.has_rates);
      ExpectSame(tracker.orientation, item[1], 0);
      ExpectSame(tracker.free_acceleration, VectorAt(item[1], 4));
      ExpectSame(tracker.acceleration, VectorAt(item[1], 7));
      ExpectSame(tracker.angular_velocity, VectorAt(item[1], 10));
      ExpectSame(tracker.magnetic_field, VectorAt(item[1], 13));
    }
  }
  void operator()(const JointAnglesMessage& got) const {
    EXPECT_EQ(got.joints_present.count() + got.ergonomic_present.count(), body.size());
    for (const Json& item : body) {
      const auto is = [&](const PointPair& points) {
        return points.parent == item[0][0] && points.child == item[0][1];
      };
      bool found = false;
      for (int joint = 0; joint < urdf::kJointCount; ++joint) {
        if (!is(PointsOf(static_cast<urdf::Joint>(joint)))) continue;
        found = true;
        EXPECT_TRUE(got.joints_present.test(urdf::At(joint)));
        ExpectSame(got.joints[urdf::At(joint)], VectorAt(item[1], 0));
      }
      for (int joint = 0; !found && joint < kErgonomicJointCount; ++joint) {
        if (!is(PointsOf(static_cast<ErgonomicJoint>(joint)))) continue;
        found = true;
        EXPECT_TRUE(got.ergonomic_present.test(urdf::At(joint)));
        ExpectSame(got.ergonomic[urdf::At(joint)], VectorAt(item[1], 0));
      }
      EXPECT_TRUE(found) << item;
    }
  }
  void operator()(const CenterOfMassMessage& got) const {
    ASSERT_EQ(body.size(), 9U);
    EXPECT_TRUE(got.has_derivatives);
    ExpectSame(got.position, VectorAt(body, 0));
    ExpectSame(got.velocity, VectorAt(body, 3));
    ExpectSame(got.acceleration, VectorAt(body, 6));
  }
  void operator()(const TimeCodeMessage& got) const {
    const int millis = got.utc_millis_of_day;
    char text[32];
    std::snprintf(text, sizeof(text), "%02d:%02d:%02d.%03d", millis / 3600000, millis / 60000 % 60,
                  millis / 1000 % 60, millis % 1000);
    EXPECT_EQ(text, body.get<std::string>());
  }
  void operator()(const MetaDataMessage& got) const {
    EXPECT_EQ(got.name, body["name"].get<std::string>());
    EXPECT_EQ(got.color_rgb, std::stoul(body["color"].get<std::string>(), nullptr, 16));
  }
  void operator()(const ScaleMessage& got) const {
    const Json& segments = body.at(0);
    const Json& points = body.at(1);
    ASSERT_EQ(got.segments.size(), segments.size());
    ASSERT_EQ(got.points.size(), points.size());
    for (std::size_t i = 0; i < got.segments.size(); ++i) {
      EXPECT_EQ(got.segments[i].name, segments[i][0]);
      ExpectSame(got.segments[i].origin_in_world, VectorAt(segments[i][1], 0));
    }
    for (std::size_t i = 0; i < got.points.size(); ++i) {
      EXPECT_EQ(got.points[i].segment_id, points[i][0]);
      EXPECT_EQ(got.points[i].point_id, points[i][1]);
      EXPECT_EQ(got.points[i].name, points[i][2]);
      EXPECT_EQ(got.points[i].flags, points[i][3]);
      ExpectSame(got.points[i].offset, VectorAt(points[i][4], 0));
    }
  }
  void operator()(const MarkersMessage&) const { FAIL() << "the reference has no such example"; }
};

TEST_F(ReferenceExamples, GiveTheSameValuesInBothParsers) {
  int compared = 0;
  for (const auto& [name, example] : json_["examples"].items()) {
    SCOPED_TRACE(name);
    const auto message = ParseDatagram(FromHex(example["hex"]));
    const Json& decoded = example["decoded"];
    // Recorded headers without their whole payload: neither takes them.
    EXPECT_EQ(message.has_value(), !decoded.is_null());
    if (!message || decoded.is_null()) continue;
    CompareHeader(message->header, decoded["head"]);
    std::visit(Compare{decoded["body"]}, message->body);
    ++compared;
  }
  EXPECT_GE(compared, 13);
}

TEST_F(ReferenceExamples, AreRejectedByBothParsersIfTruncated) {
  for (const auto& [name, example] : json_["examples"].items()) {
    const std::string whole = FromHex(example["hex"]);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_FALSE(ParseDatagram(std::string_view(whole).substr(0, size))) << name << " " << size;
    }
  }
}

TEST_F(ReferenceExamples, AreFoundEquallyInAStreamWithForeignBytes) {
  StreamFramer framer;
  framer.Append(FromHex(json_["stream"]));
  framer.End();
  std::vector<std::string> got;
  while (const auto datagram = framer.Next()) {
    if (datagram->substr(0, 4) == "MXTP") got.emplace_back(*datagram);
  }
  std::vector<std::string> wanted;
  for (const Json& hex : json_["cut"]) wanted.push_back(FromHex(hex));
  EXPECT_EQ(got, wanted);
}

}  // namespace
}  // namespace kinescope::mvn
