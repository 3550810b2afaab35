#include "server/http/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "server/http/look_back.h"
#include "tests/folders.h"
#include "tests/server/http/past_message.h"
#include "tests/server/http/test_scene.h"
#include "tests/worn.h"

namespace kinescope::http {
namespace {

using Eigen::Vector3d;

// Reads as docs/http.md says, without any code of the writer.
class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}

  template <class T>
  T Get() {
    T value{};
    if (offset_ + sizeof(T) > bytes_.size()) {
      ADD_FAILURE() << "the message ends at byte " << bytes_.size();
      return value;
    }
    std::memcpy(&value, bytes_.data() + offset_,
                sizeof(T));  // every machine we test on is little-endian
    offset_ += sizeof(T);
    return value;
  }
  Vector3d GetVector() {
    const float x = Get<float>(), y = Get<float>(), z = Get<float>();
    return {x, y, z};
  }
  bool AtEnd() const { return offset_ == bytes_.size(); }

 private:
  const Bytes& bytes_;
  std::size_t offset_ = 0;
};

SceneState SceneToSend(int people = 1) {
  return testing::MakeScene(41, 3.25, 5'000'000'000, testing::MakePersonModel(7), people);
}

void ExpectPerson(Reader& in, const PersonState& person) {
  EXPECT_EQ(in.Get<std::int32_t>(), person.character);
  EXPECT_EQ(in.Get<std::uint8_t>(), 1 | 2 | 8 | 16) << "CoM, CoP, assumed mass, dynamic";
  EXPECT_EQ(in.Get<std::uint8_t>(), urdf::kSegmentCount);
  EXPECT_EQ(in.Get<std::uint8_t>(), person.loads.size());
  const HandLoadShape held = ShapeOfHandLoad(person);
  EXPECT_EQ(in.Get<std::uint8_t>(), held.count);
  EXPECT_EQ(in.Get<double>(), 7);
  EXPECT_TRUE(in.GetVector().isApprox(*person.com, 1e-6));
  EXPECT_TRUE(in.GetVector().isApprox(*person.cop, 1e-6));
  EXPECT_FLOAT_EQ(in.Get<float>(), static_cast<float>(person.forces.lumbar->compression));
  EXPECT_FLOAT_EQ(in.Get<float>(), static_cast<float>(*person.forces.margin_of_stability));
  EXPECT_TRUE(std::isnan(in.Get<float>())) << "MVN sent no centre of mass";
  EXPECT_EQ(in.Get<float>(), 5);
  EXPECT_EQ(in.Get<float>(), 0);
  const SupportPolygon& support = person.forces.support;
  EXPECT_EQ(in.Get<std::uint8_t>(), support.size);
  EXPECT_EQ(in.Get<std::uint8_t>(), static_cast<int>(LoadMetric::kTotal));
  EXPECT_EQ(in.Get<std::uint16_t>(), 0) << "reserved";
  for (const urdf::Pose& link : person.links) {
    EXPECT_LT((in.GetVector() - link.position).norm(), 1e-6);
    const float x = in.Get<float>(), y = in.Get<float>(), z = in.Get<float>(), w = in.Get<float>();
    EXPECT_LT((Eigen::Vector4d(x, y, z, w) - link.orientation.coeffs()).norm(), 1e-6);
  }
  for (const JointLoad& load : person.loads) {
    EXPECT_EQ(in.Get<std::uint8_t>(), load.joint);
    EXPECT_EQ(in.Get<std::uint8_t>(), static_cast<int>(load.load_class));
    const double radius = in.Get<std::uint16_t>() / 1000.0;
    EXPECT_NEAR(radius, SphereRadius(load.joint, load.load_class, *person.model), 0.000501);
    EXPECT_LT((in.GetVector() - load.position).norm(), 1e-6);
    for (const double value : {load.ratio, load.deciding_moment, load.capacity}) {
      const float sent = in.Get<float>();
      EXPECT_TRUE(std::isnan(value) ? std::isnan(sent) : std::abs(sent - value) < 1e-4) << value;
    }
  }
  for (std::size_t i = 0; i < support.size; ++i) {
    const float x = in.Get<float>(), y = in.Get<float>();
    EXPECT_LT((Eigen::Vector2d(x, y) - support.corners[i]).norm(), 1e-6);
  }
  for (const FootForce& foot : person.forces.feet) {
    const Eigen::Vector3d cop = in.GetVector(), force = in.GetVector();
    if (foot.force.norm() > kMinForceShown) {
      EXPECT_LT((cop - foot.cop).norm(), 1e-6);
      EXPECT_LT((force - foot.force).norm(), 1e-3);
    } else {
      EXPECT_TRUE(cop.array().isNaN().all() && force.array().isNaN().all());
    }
  }
  for (std::size_t i = 0; i < held.count; ++i) {
    EXPECT_EQ(in.Get<std::uint32_t>(), static_cast<std::uint32_t>(held.solids[i].kind));
    EXPECT_LT((in.GetVector() - held.solids[i].pose.position).norm(), 1e-6);
    for (int part = 0; part < 4; ++part) {
      EXPECT_NEAR(in.Get<float>(), held.solids[i].pose.orientation.coeffs()[part], 1e-6);
    }
    EXPECT_LT((in.GetVector() - held.solids[i].size).norm(), 1e-6);
  }
}

TEST(StateMessage, HasEveryFieldAtItsDocumentedPlace) {
  SceneState state = SceneToSend(2);
  state.floor_z = -0.75;
  state.waited_nanos = 3'719'000'000;
  state.view_heading = -2.5;
  state.made_nanos = 5'001'000'000;
  const history::Extent kept = {2'000'000'000, 5'001'000'000, 12, 41};
  const Bytes bytes = EncodeState(state, {5'004'000'000, 3, kept});
  Reader in(bytes);
  EXPECT_EQ(in.Get<std::uint8_t>(), 1);
  EXPECT_EQ(in.Get<std::uint8_t>(), kProtocolVersion);
  EXPECT_EQ(in.Get<std::uint8_t>(), static_cast<int>(Liveness::kLive));
  EXPECT_EQ(in.Get<std::uint8_t>(), 2);
  EXPECT_EQ(in.Get<std::uint32_t>(), state.counter);
  EXPECT_EQ(in.Get<double>(), 41);
  EXPECT_EQ(in.Get<double>(), 5'004'000);
  EXPECT_EQ(in.Get<double>(), 5'000'000);
  EXPECT_EQ(in.Get<double>(), static_cast<double>(state.stamp_nanos) / 1e3);
  EXPECT_EQ(in.Get<double>(), 3250);
  EXPECT_EQ(in.Get<float>(), 60);
  EXPECT_EQ(in.Get<std::uint32_t>(), 3);
  EXPECT_EQ(in.Get<float>(), -0.75);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(in.Get<std::uint8_t>(), 0) << "objects, ghosts";
  EXPECT_EQ(in.Get<std::uint16_t>(), 371) << "waited, in 10 ms";
  EXPECT_EQ(in.Get<float>(), -2.5);
  EXPECT_EQ(in.Get<std::uint32_t>(), 0u) << "robots";
  EXPECT_EQ(in.Get<double>(), 5'001'000);
  EXPECT_EQ(in.Get<double>(), 2'000'000);
  EXPECT_EQ(in.Get<double>(), 12);
  for (const PersonState& person : state.people) ExpectPerson(in, person);
  EXPECT_TRUE(in.AtEnd());
}

TEST(StateMessage, HasFingersAndPropsInTheOrderOfTheModel) {
  SceneState state = SceneToSend();
  PersonState& person = state.people[0];
  kinescope::testing::Wear(person);
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[kStateHeaderBytes + 5], 23 + 40 + 2);
  const Bytes bare = EncodeState(SceneToSend(), {0, 1, {}});
  EXPECT_EQ(bytes.size(), bare.size() + 42 * kLinkBytes);
  const auto position_of = [&](std::size_t link) {
    const std::size_t at = kStateHeaderBytes + kPersonHeaderBytes + link * kLinkBytes;
    const Bytes rest(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end());
    return Reader(rest).GetVector();
  };
  EXPECT_LT((position_of(22) - person.links[22].position).norm(), 1e-6);
  EXPECT_LT((position_of(23) - person.gloves[urdf::kRight]->links[0].position).norm(), 1e-6);
  EXPECT_LT((position_of(62) - person.gloves[urdf::kLeft]->links[19].position).norm(), 1e-6);
  EXPECT_LT((position_of(64) - person.props[2]->pose.position).norm(), 1e-6);
}

TEST(StateMessage, HasTrackedObjectsAfterThePeople) {
  SceneState state = SceneToSend();
  const std::size_t people = EncodeState(state, {0, 1, {}}).size();
  const urdf::Pose pose{{1, -2, 0.5}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)};
  state.objects = {{4, 0, "tool", pose, 5}, {-4, 22, "cart", pose, 5}};
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[60], 2);
  ASSERT_EQ(bytes.size(), people + 2 * kObjectBytes);
  const Bytes second(bytes.end() - static_cast<std::ptrdiff_t>(kObjectBytes), bytes.end());
  Reader in(second);
  EXPECT_EQ(in.Get<std::int32_t>(), -4);
  EXPECT_EQ(in.Get<std::uint8_t>(), 22);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(in.Get<std::uint8_t>(), 0);
  EXPECT_EQ(in.GetVector(), pose.position);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(in.Get<float>(), pose.orientation.coeffs()[i]);
  state.objects.resize(300, state.objects.front());
  EXPECT_EQ(EncodeState(state, {0, 1, {}})[60], 255);
  EXPECT_EQ(EncodeState(state, {0, 1, {}}).size(), people + 255 * kObjectBytes);
}

TEST(StateMessage, HasReferencePosesAfterTheObjects) {
  SceneState state = SceneToSend();
  const std::size_t without = EncodeState(state, {0, 1, {}}).size();
  Ghost ghost{state.people[0]};
  ghost.person.character = kFirstGhost;
  ghost.person.loads.clear();
  ghost.person.forces = BodyForces();
  state.ghosts = {ghost};
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[61], 1);
  const std::size_t size = kPersonHeaderBytes + urdf::kSegmentCount * kLinkBytes + 2 * kFootBytes;
  ASSERT_EQ(bytes.size(), without + size);
  const Bytes last(bytes.end() - static_cast<std::ptrdiff_t>(size), bytes.end());
  Reader in(last);
  EXPECT_EQ(in.Get<std::int32_t>(), kFirstGhost);
}

TEST(StateMessage, HasTheDrawnLinksOfRobotsThatMoveAtItsEnd) {
  SceneState state = SceneToSend();
  const std::size_t without = EncodeState(state, {0, 1, {}}).size();
  RobotState robot;
  auto model = std::make_shared<urdf::RobotModel>();
  model->links.resize(3);
  model->links[0].visuals.resize(1);
  model->links[2].visuals.resize(2);
  robot.model = model;
  robot.world_from_link.assign(3, Eigen::Isometry3d::Identity());
  robot.world_from_link[0].matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  robot.world_from_link[2].pretranslate(Eigen::Vector3d(1, -2, 0.5));
  state.robots = {robot};
  EXPECT_EQ(EncodeState(state, {0, 1, {}}).size(), without) << "it stands";
  state.robots[0].moves = true;
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[68], 1);
  const std::size_t size = kRobotHeaderBytes + 2 * kLinkBytes;
  ASSERT_EQ(bytes.size(), without + size);
  const Bytes last(bytes.end() - static_cast<std::ptrdiff_t>(size), bytes.end());
  Reader in(last);
  EXPECT_EQ(in.Get<std::uint16_t>(), 2);
  EXPECT_EQ(in.Get<std::uint16_t>(), 0);
  EXPECT_TRUE(std::isnan(in.GetVector().x())) << "it is nowhere";
  for (int i = 0; i < 4; ++i) in.Get<float>();
  EXPECT_EQ(in.GetVector(), Eigen::Vector3d(1, -2, 0.5));
  EXPECT_EQ(in.Get<float>(), 0);
  state.robots.assign(300, state.robots[0]);
  EXPECT_EQ(EncodeState(state, {0, 1, {}}).size(), without + 255 * size);
}

TEST(StateMessage, HasTheFrameThatTheOwnCameraGoesWithAtItsEnd) {
  SceneState state = SceneToSend();
  const std::size_t without = EncodeState(state, {0, 1, {}}).size();
  EXPECT_EQ(EncodeState(state, {0, 1, {}})[69], 0);
  state.camera_base = urdf::Pose{Eigen::Vector3d(1, -2, 0.5), Eigen::Quaterniond(0.6, 0, 0, 0.8)};
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[69], 1);
  ASSERT_EQ(bytes.size(), without + kLinkBytes);
  const Bytes last(bytes.end() - static_cast<std::ptrdiff_t>(kLinkBytes), bytes.end());
  Reader in(last);
  EXPECT_EQ(in.GetVector(), Eigen::Vector3d(1, -2, 0.5));
  for (const float part : {0.0F, 0.0F, 0.8F, 0.6F}) EXPECT_EQ(in.Get<float>(), part);
}

TEST(StateMessage, EndsWithTheExtentOfASceneWithoutPeople) {
  SceneState state;
  const std::size_t without = EncodeState(state, {0, 1, {}}).size();
  EXPECT_EQ(EncodeState(state, {0, 1, {}})[70], 0);
  state.extent = {Eigen::Vector3d(-1, 0, 0.5), Eigen::Vector3d(2, 3, 4)};
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[70], 1);
  ASSERT_EQ(bytes.size(), without + 6 * sizeof(float));
  const Bytes last(bytes.end() - 6 * sizeof(float), bytes.end());
  Reader in(last);
  EXPECT_EQ(in.GetVector(), Eigen::Vector3d(-1, 0, 0.5));
  EXPECT_EQ(in.GetVector(), Eigen::Vector3d(2, 3, 4));
}

TEST(StateMessage, OfOnePersonWithALoadStaysBelow1500Bytes) {
  EXPECT_LT(EncodeState(SceneToSend(), {0, 1, {}}).size(), 1500u);
}

TEST(StateMessage, ConsistsOfItsHeaderWithoutPeople) {
  EXPECT_EQ(EncodeState(SceneState(), {0, 0, {}}).size(), kStateHeaderBytes);
}

TEST(StateMessage, ContainsAtMost255People) {
  SceneState state = SceneToSend();
  state.people.resize(300, state.people.front());
  const Bytes bytes = EncodeState(state, {0, 1, {}});
  EXPECT_EQ(bytes[3], 255);
  const std::size_t person_bytes =
      EncodeState(SceneToSend(), {0, 1, {}}).size() - kStateHeaderBytes;
  EXPECT_EQ(bytes.size(), kStateHeaderBytes + 255 * person_bytes);
}

TEST(StateMessage, MarksMissingValues) {
  SceneState state = SceneToSend();
  state.people[0].com.reset();
  state.people[0].cop.reset();
  EXPECT_EQ(EncodeState(state, {0, 1, {}})[kStateHeaderBytes + 4] & 3, 0);
}

TEST(PictureMessage, ContainsTheNumberOfItsState) {
  const Bytes bytes = EncodePicture({{0xFF, 0xD8, 0xFF}, 41, 5'000'000'000});
  Reader in(bytes);
  EXPECT_EQ(in.Get<std::uint8_t>(), 2);
  EXPECT_EQ(in.Get<std::uint8_t>(), kProtocolVersion);
  in.Get<std::uint16_t>();
  in.Get<std::uint32_t>();
  EXPECT_EQ(in.Get<double>(), 41);
  EXPECT_EQ(in.Get<double>(), 5'000'000);
  EXPECT_EQ(bytes.size(), kPictureHeaderBytes + 3);
  EXPECT_EQ(bytes.back(), 0xFF);
}

TEST(PastMessage, ContainsStatesAndTheTextsThatHaveChanged) {
  SceneState state = SceneToSend();
  PastEncoder encoder(9, {});
  encoder.Add(state, "one");
  state.number = 42;
  encoder.Add(state, "");
  EXPECT_EQ(encoder.count(), 2u);
  const std::size_t size = encoder.bytes();
  const Bytes bytes = encoder.Finish(5'000'000'000);
  EXPECT_EQ(bytes.size(), size);
  const testing::PastMessage past(bytes);
  EXPECT_EQ(past.id, 9u);
  EXPECT_EQ(past.until_micros, 5'000'000);
  EXPECT_EQ(past.Numbers(), (std::vector<std::uint64_t>{SceneToSend().number, 42}));
  EXPECT_EQ(past.states[0].details, "one");
  EXPECT_EQ(past.states[1].details, "");
  EXPECT_EQ(bytes.size(),
            kPastHeaderBytes + 3 + 2 * (kPastStateBytes + EncodeState(state, {}).size()));
}

TEST(ClientCommand, IsOneJsonObjectWithKnownMembers) {
  const auto command = ParseCommand(R"({"pictures": true, "camera": "front", "ping": 12.5})");
  ASSERT_TRUE(command) << command.error();
  EXPECT_EQ(command->pictures, true);
  EXPECT_EQ(command->camera, "front");
  EXPECT_EQ(command->ping, 12.5);
  EXPECT_TRUE(ParseCommand("{}"));
  const auto run = ParseCommand(
      R"({"few_states": true, "look": {"id": 3, "micros": 5.5, "until_micros": 8, "every_micros": 2}})");
  ASSERT_TRUE(run) << run.error();
  EXPECT_EQ(run->few_states, true);
  EXPECT_EQ(run->look->id, 3u);
  EXPECT_EQ(run->look->span.from_nanos, 5500);
  EXPECT_EQ(run->look->span.until_nanos, 8000);
  EXPECT_EQ(run->look->span.every_nanos, 2000);
  const auto seen = ParseCommand(R"({"seen_states": 7, "seen_pictures": 0})");
  ASSERT_TRUE(seen) << seen.error();
  EXPECT_EQ(seen->seen_states, 7u);
  EXPECT_EQ(seen->seen_pictures, 0u);
}

TEST(ClientCommand, IsRejectedIfItIsInvalid) {
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("1"), std::string("null"),
        std::string(R"({"pictures": 1})"), std::string(R"({"camera": 3})"),
        std::string(R"({"ping": "1"})"), std::string(R"({"seen_states": -1})"),
        std::string(R"({"seen_states": 1.5})"), std::string(R"({"picture": true})"),
        std::string("\xFF\xFE"), R"({"camera": ")" + std::string(65, 'a') + "\"}",
        std::string(2000, '['), std::string(R"({"ping": 1e999})")}) {
    const auto command = ParseCommand(text);
    EXPECT_FALSE(command) << text;
    EXPECT_TRUE(command || !command.error().empty()) << text;
  }
}

TEST(ClientCommand, NeedsTheRoleOfItsMostPowerfulMember) {
  const auto looks = ParseCommand(R"({"look": {"id": 1, "number": 0}, "pictures": true})");
  ASSERT_TRUE(looks) << looks.error();
  EXPECT_EQ(looks->least, Role::kViewer) << "a viewer looks back alone";
  const auto both = ParseCommand(R"({"ping": 1, "camera": "front"})");
  ASSERT_TRUE(both) << both.error();
  EXPECT_EQ(both->least, Role::kOperator);
  EXPECT_EQ(both->needs_least, "camera");
}

TEST(ClientCommand, ThatIsInvalidIsExplained) {
  EXPECT_EQ(ParseCommand(R"({"camera": 3})").error(), "camera: expected a name");
  EXPECT_THAT(ParseCommand(R"({"kamera": "front"})").error(), ::testing::HasSubstr("\"camera\""));
}

TEST(ClientCommand, IsListedWithAValidExample) {
  for (const CommandInfo& info : Commands()) {
    const auto command = ParseCommand(info.example);
    ASSERT_TRUE(command) << info.example << ": " << command.error();
    EXPECT_EQ(command->least, info.least) << info.example;
  }
}

TEST(ProtocolManual, StatesTheSizesAndTheVersion) {
  std::ifstream file(kinescope::testing::InSourceTree("docs/http.md"));
  const std::string manual(std::istreambuf_iterator<char>(file), {});
  const auto expect = [&](const std::string& text) {
    EXPECT_NE(manual.find(text), std::string::npos) << "docs/http.md does not say: " << text;
  };
  expect("protocol version " + std::to_string(kProtocolVersion));
  expect("header, " + std::to_string(kStateHeaderBytes) + " bytes");
  expect("person, " + std::to_string(kPersonHeaderBytes) + " bytes");
  expect("link, " + std::to_string(kLinkBytes) + " bytes");
  expect("load, " + std::to_string(kLoadBytes) + " bytes");
  expect("object, " + std::to_string(kObjectBytes) + " bytes");
  expect("corner, " + std::to_string(kCornerBytes) + " bytes");
  expect("foot, " + std::to_string(kFootBytes) + " bytes");
  expect("solid, " + std::to_string(kSolidBytes) + " bytes");
  expect("former states header, " + std::to_string(kPastHeaderBytes) + " bytes");
  expect("former state, " + std::to_string(kPastStateBytes) + " bytes");
  expect("At most " + std::to_string(kMaxPastStates) + " states");
  expect("picture header, " + std::to_string(kPictureHeaderBytes) + " bytes");
}

}  // namespace
}  // namespace kinescope::http
