#include "tests/render/test_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "urdf/human_urdf.h"

// OSMesa keeps some 500 bytes of every context that it destroys; nothing of ours is excused.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa.so\n"; }

namespace kinescope::testing {
namespace {

using Eigen::Vector3d;
using namespace urdf;

Vector3d Degrees(double x, double y, double z) { return Vector3d(x, y, z) * (M_PI / 180); }

void SetBoth(JointAngles& angles, int right, int left, double x, double y, double z = 0) {
  angles[static_cast<std::size_t>(right)] = Degrees(x, y, z);
  angles[static_cast<std::size_t>(left)] = Degrees(-x, y, -z);
}

JointAngles AnglesOf(Posture posture) {
  JointAngles angles;
  angles.fill(Vector3d::Zero());
  if (posture == Posture::kArmsForward) {
    SetBoth(angles, jRightShoulder, jLeftShoulder, 0, -90);
  } else if (posture == Posture::kDeepBend) {
    for (const int joint : {jL5S1, jL4L3, jL1T12, jT9T8})
      angles[static_cast<std::size_t>(joint)] = Degrees(0, 14, 0);
    angles[jC1Head] = Degrees(0, -25, 0);
    SetBoth(angles, jRightShoulder, jLeftShoulder, -12, -75);
    SetBoth(angles, jRightElbow, jLeftElbow, 0, -25);
    SetBoth(angles, jRightHip, jLeftHip, -10, -75);
    SetBoth(angles, jRightKnee, jLeftKnee, 0, 75);
    SetBoth(angles, jRightAnkle, jLeftAnkle, 0, -30);
  }
  return angles;
}

double LowestPoint(const Skeleton& skeleton, const LinkPoses& links) {
  double lowest = std::numeric_limits<double>::max();
  const auto take = [&](int segment, const Vector3d& in_link) {
    const Pose& pose = links[static_cast<std::size_t>(segment)];
    lowest = std::min(lowest, (pose.position + pose.orientation * in_link).z());
  };
  take(kRightFoot, skeleton.heel_in_foot[kRight]);
  take(kLeftFoot, skeleton.heel_in_foot[kLeft]);
  take(kRightToe, skeleton.toe_tip_in_toe[kRight]);
  take(kLeftToe, skeleton.toe_tip_in_toe[kLeft]);
  return lowest;
}

LinkPoses LinksOf(const Skeleton& skeleton, Posture posture, double x, double y) {
  Pose pelvis;
  if (posture == Posture::kDeepBend) {
    pelvis.orientation = Eigen::AngleAxisd(30 * M_PI / 180, Vector3d::UnitY());
  }
  LinkPoses links = ForwardKinematics(skeleton, pelvis, AnglesOf(posture));
  const Vector3d shift(x, y, -LowestPoint(skeleton, links));
  for (Pose& pose : links) pose.position += shift;
  return links;
}

double RatioOf(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kLow: return 0.12;
    case LoadClass::kMedium: return 0.45;
    case LoadClass::kHigh: return 0.82;
    case LoadClass::kUnknown: break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void SetClass(JointLoad& load, LoadClass load_class) {
  load.load_class = load_class;
  load.ratio = load.shown_ratio = RatioOf(load_class);
}

}  // namespace

const std::array<int, 15> kSphereJoints = {jL5S1,         jT9T8,       jT1C7,      jRightShoulder,
                                           jLeftShoulder, jRightElbow, jLeftElbow, jRightWrist,
                                           jLeftWrist,    jRightHip,   jLeftHip,   jRightKnee,
                                           jLeftKnee,     jRightAnkle, jLeftAnkle};

std::shared_ptr<const PersonModel> MakePersonModel(std::uint64_t revision) {
  // Once: tests ask for it for every scene, and writing and reading a URDF takes long.
  static const PersonModel person = [] {
    PersonModel made;
    made.human.skeleton = DefaultSkeleton();
    made.description.mass_is_assumed = false;
    made.human.body = MakeBodyParameters(made.description, made.human.skeleton);
    made.urdf_xml = WriteUrdf(made.human);
    made.robot = ParseUrdf(made.urdf_xml);
    return made;
  }();
  auto model = std::make_shared<PersonModel>(person);
  model->revision = revision;
  return model;
}

SceneState SceneWith(Posture posture, LoadClass load_class, double x, double y) {
  SceneState state;
  state.liveness = Liveness::kLive;
  state.number = 741;
  state.counter = 740;
  state.time_code_millis = 12'345;
  state.arrival_nanos = 1;
  state.rate_hz = 60;
  state.source = "udp://0.0.0.0:9763";
  PersonState person;
  person.model = MakePersonModel();
  person.links = LinksOf(person.model->human.skeleton, posture, x, y);
  person.com = person.links[kPelvis].position + Vector3d(0.03, 0, 0.02);
  person.cop = Vector3d(person.com->x(), person.com->y() - 0.03, 0);
  for (const int joint : kSphereJoints) {
    JointLoad load;
    load.joint = joint;
    load.position = person.links[static_cast<std::size_t>(ChildOf(joint))].position;
    SetClass(load, load_class);
    person.loads.push_back(load);
  }
  state.people.push_back(std::move(person));
  return state;
}

SceneState MixedScene(Posture posture) {
  SceneState state = SceneWith(posture);
  for (const int joint : {jT9T8, jRightShoulder, jRightHip, jLeftKnee}) {
    SetClass(LoadOf(state, joint), LoadClass::kMedium);
  }
  for (const int joint : {jL5S1, jLeftShoulder, jRightKnee}) {
    SetClass(LoadOf(state, joint), LoadClass::kHigh);
  }
  SetClass(LoadOf(state, jLeftWrist), LoadClass::kUnknown);
  return state;
}

SceneState BodyAlone(Posture posture) {
  SceneState state = SceneWith(posture);
  PersonState& person = state.people[0];
  person.loads.clear();
  person.com.reset();
  person.cop.reset();
  return state;
}

render::Camera FrontCamera() {
  render::Camera camera;
  camera.position = {4, 0, 1};
  camera.target = {0, 0, 1};
  return camera;
}

JointLoad& LoadOf(SceneState& state, int joint) {
  for (JointLoad& load : state.people.at(0).loads) {
    if (load.joint == joint) return load;
  }
  throw std::logic_error("no load sphere at this joint");
}

}  // namespace kinescope::testing
