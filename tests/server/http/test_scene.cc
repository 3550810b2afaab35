#include "tests/server/http/test_scene.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <utility>

namespace kinescope::http::testing {
namespace {

using Eigen::Vector3d;

// Those that tests write into a folder.
class MeshesInFolder : public MeshFiles {
 public:
  explicit MeshesInFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::shared_ptr<const std::string> Content(const std::string& name) const override {
    if (!std::filesystem::is_regular_file(folder_ / name)) return nullptr;
    std::string content(std::filesystem::file_size(folder_ / name), '\0');
    std::ifstream(folder_ / name, std::ios::binary)
        .read(content.data(), static_cast<std::streamsize>(content.size()));
    return std::make_shared<const std::string>(std::move(content));
  }
  bool Provide() const override { return true; }

 private:
  const std::filesystem::path folder_;
};

constexpr std::array<int, 15> kJoints = {
    urdf::jL5S1,         urdf::jT9T8,       urdf::jT1C7,      urdf::jRightShoulder,
    urdf::jLeftShoulder, urdf::jRightElbow, urdf::jLeftElbow, urdf::jRightWrist,
    urdf::jLeftWrist,    urdf::jRightHip,   urdf::jLeftHip,   urdf::jRightKnee,
    urdf::jLeftKnee,     urdf::jRightAnkle, urdf::jLeftAnkle};

Vector3d& AngleOf(urdf::JointAngles& angles, int joint) {
  return angles[static_cast<std::size_t>(joint)];
}

// Bends forward and comes up again, arms reaching out.
urdf::JointAngles AnglesAt(double seconds) {
  const double bend = 0.5 - 0.5 * std::cos(2 * M_PI * seconds / 4);
  urdf::JointAngles angles{};
  for (Vector3d& angle : angles) angle.setZero();
  for (const int joint : {urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8}) {
    AngleOf(angles, joint).y() = 0.22 * bend;
  }
  for (const int joint : {urdf::jRightShoulder, urdf::jLeftShoulder}) {
    AngleOf(angles, joint).y() = -0.5 - 1.0 * bend;
  }
  for (const int joint : {urdf::jRightElbow, urdf::jLeftElbow}) {
    AngleOf(angles, joint).y() = -0.9 + 0.5 * bend;
  }
  for (const int joint : {urdf::jRightHip, urdf::jLeftHip})
    AngleOf(angles, joint).y() = -0.6 * bend;
  for (const int joint : {urdf::jRightKnee, urdf::jLeftKnee})
    AngleOf(angles, joint).y() = 0.9 * bend;
  for (const int joint : {urdf::jRightAnkle, urdf::jLeftAnkle}) {
    AngleOf(angles, joint).y() = -0.3 * bend;
  }
  return angles;
}

LoadClass ClassOf(double ratio) {
  if (std::isnan(ratio)) return LoadClass::kUnknown;
  return ratio > 0.6 ? LoadClass::kHigh : ratio > 0.3 ? LoadClass::kMedium : LoadClass::kLow;
}

JointLoad MakeLoad(std::size_t i, double seconds, const urdf::LinkPoses& links) {
  JointLoad load;
  load.joint = kJoints[i];
  load.position = links[static_cast<std::size_t>(urdf::ChildOf(load.joint))].position;
  load.capacity = 40 + 15 * static_cast<double>(i);
  // From 0.9 downwards along the list, so that every class is there at any time.
  load.ratio =
      0.9 - 0.06 * static_cast<double>(i) + 0.02 * std::sin(seconds + static_cast<double>(i));
  load.channel = "flexion";
  if (load.joint == urdf::jLeftAnkle) {
    load.ratio = std::numeric_limits<double>::quiet_NaN();
    load.capacity = 0;
    load.channel = {};
    load.reason = "left foot is not on the floor";
  }
  load.deciding_moment = -load.ratio * load.capacity;
  load.moment = Vector3d(0, load.deciding_moment, 0);
  load.shown_ratio = load.ratio;
  load.load_class = load.band = ClassOf(load.ratio);
  return load;
}

// Five kilograms in the right hand, on both feet.
void AddForces(PersonState& person) {
  BodyForces& forces = person.forces;
  forces.is_dynamic = true;
  forces.body_mass_kg = 75;
  forces.body_mass_is_assumed = true;
  const Vector3d middle = *person.cop;
  forces.support.size = 4;
  forces.support.corners[0] = {middle.x() - 0.1, middle.y() - 0.15};
  forces.support.corners[1] = {middle.x() + 0.2, middle.y() - 0.15};
  forces.support.corners[2] = {middle.x() + 0.2, middle.y() + 0.15};
  forces.support.corners[3] = {middle.x() - 0.1, middle.y() + 0.15};
  forces.margin_of_stability = 0.083;
  forces.lumbar = LumbarLoad{2150, 310};
  FootForce& foot = forces.feet[urdf::kRight];  // the left one is in the air
  foot.force = {12, -5, 730};
  foot.cop = {middle.x(), middle.y() - 0.1, 0};
  forces.stated_hand_load.is_known = true;
  forces.stated_hand_load.mass_kg[urdf::kRight] = 5;
  const urdf::Pose& hand = person.links[urdf::kRightHand];
  HandForce& held = forces.hands[urdf::kRight];
  held.mass_kg = 5;
  held.force = {0, 0, -49.05};
  held.point = held.grip = hand.position + hand.orientation * Vector3d(0, 0, -0.08);
}

PersonState MakePerson(int character, double seconds,
                       const std::shared_ptr<const PersonModel>& model) {
  PersonState person;
  person.character = character;
  person.name = character == 0 ? "Demo" : "Demo " + std::to_string(character + 1);
  person.model = model;
  person.angles = AnglesAt(seconds);
  urdf::Pose pelvis;
  const urdf::Skeleton& skeleton = model->human.skeleton;
  pelvis.position = Vector3d(0, 1.2 * character, urdf::NPoseOrigins(skeleton)[urdf::kPelvis].z());
  person.links = urdf::ForwardKinematics(skeleton, pelvis, person.angles);
  const double lowest = person.links[urdf::kRightToe].position.z();
  for (urdf::Pose& link : person.links) link.position.z() += 0.03 - lowest;
  person.com = person.links[urdf::kL3].position + Vector3d(0.05, 0, 0);
  person.cop = Vector3d(person.com->x() + 0.02, person.com->y(), 0);
  for (std::size_t i = 0; i < kJoints.size(); ++i) {
    person.loads.push_back(MakeLoad(i, seconds, person.links));
  }
  AddForces(person);
  return person;
}

}  // namespace

std::shared_ptr<const PersonModel> MakePersonModel(std::uint64_t revision,
                                                   const std::string& mesh_folder) {
  auto model = std::make_shared<PersonModel>();
  model->revision = revision;
  model->human.skeleton = urdf::DefaultSkeleton(1.75);
  model->human.body = urdf::MakeBodyParameters(model->description, model->human.skeleton);
  model->human.mesh_folder = mesh_folder;
  if (!mesh_folder.empty()) model->mesh_files = std::make_shared<MeshesInFolder>(mesh_folder);
  model->urdf_xml = urdf::WriteUrdf(model->human);
  model->robot = urdf::ParseUrdf(model->urdf_xml);
  return model;
}

SceneState MakeScene(std::uint64_t number, double seconds, std::int64_t arrival_nanos,
                     const std::shared_ptr<const PersonModel>& model, int people) {
  SceneState state;
  state.liveness = Liveness::kLive;
  state.number = number;
  state.counter = static_cast<std::uint32_t>(60 * seconds + 1e-6);
  state.time_code_millis = static_cast<std::int64_t>(1000 * seconds);
  state.stamp_nanos = 1700000000000000000 + static_cast<std::int64_t>(1e9 * seconds);
  state.arrival_nanos = arrival_nanos;
  state.rate_hz = 60;
  state.source = "udp://0.0.0.0:9763";
  for (int i = 0; i < people; ++i) {
    state.people.push_back(MakePerson(i, seconds, model));
    BodySample& sample = state.people.back().sample;
    sample.character = i;
    sample.counter = state.counter;
    sample.stamp_nanos = state.stamp_nanos;
  }
  return state;
}

std::vector<CameraView> MakeCameras() {
  const Vector3d target(0, 0, 1.02);
  const auto view = [&](const char* name, double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * M_PI / 180, e = elevation_deg * M_PI / 180;
    CameraView camera;
    camera.name = name;
    camera.target = target;
    camera.position =
        target + 4.6 * Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    return camera;
  };
  CameraView top = view("top", 0, 90);
  top.up = Vector3d::UnitX();
  return {view("front", 0, 6),
          view("back", 180, 6),
          view("left", 90, 6),
          view("right", -90, 6),
          top,
          view("iso", 45, 35.26),
          view("three_quarter", -38, 14)};
}

CameraFraming MakeFraming() { return {1.9, 0.7, 4.0 / 3, 50, 2.5}; }

}  // namespace kinescope::http::testing
