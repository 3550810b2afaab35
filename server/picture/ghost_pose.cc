#include "server/picture/ghost_pose.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/system/errors.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

std::vector<PersonState> ReadMoment(const GhostValue& ghost, const SceneOptions& options) {
  CheckReach("--ghost=" + ghost.ToText(), ghost->secs, ghost->source);
  SceneOptions alone = options;
  alone.bag = {};  // what is beside that person is not shown
  SceneReader reader(ghost->source, alone);
  SceneTimeline timeline(reader);
  const auto scene = timeline.At(ghost->secs);
  if (!scene || scene->people.empty()) {
    throw UsageError("--ghost=" + ghost.ToText() + ": no person at that time");
  }
  return scene->people;
}

// Fingers and props go along with the hand, and with the pelvis.
void Carry(const urdf::LinkPoses& before, PersonState& person) {
  const auto carry = [&](int segment, urdf::Pose& pose) {
    const urdf::Pose in_link = urdf::Relative(before[urdf::At(segment)], pose);
    const urdf::Pose& now = person.links[urdf::At(segment)];
    pose.position = now.position + now.orientation * in_link.position;
    pose.orientation = now.orientation * in_link.orientation;
  };
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    auto& glove = person.gloves[side];
    if (!glove) continue;
    for (urdf::Pose& link : glove->links) carry(urdf::HandSegmentOf(side), link);
  }
  for (auto& prop : person.props) {
    if (prop) carry(urdf::kPelvis, prop->pose);
  }
}

PersonState NeutralPose(PersonState person, bool is_t_pose, double floor_z) {
  urdf::JointAngles angles;
  angles.fill(Vector3d::Zero());
  if (is_t_pose) {  // link frames are those of the N-pose
    angles[urdf::jRightShoulder].x() = -M_PI_2;
    angles[urdf::jLeftShoulder].x() = M_PI_2;
  }
  const urdf::Pose& now = person.links[urdf::kPelvis];
  const Vector3d ahead = now.orientation * Vector3d::UnitX();
  urdf::Pose pelvis;
  pelvis.position = now.position;
  pelvis.orientation = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Vector3d::UnitZ());
  const urdf::Skeleton& skeleton = person.model->human.skeleton;
  const urdf::LinkPoses before = person.links;
  person.links = urdf::ForwardKinematics(skeleton, pelvis, angles);
  const double lift = floor_z - urdf::LowestSolePoint(skeleton, person.links);
  for (urdf::Pose& link : person.links) link.position.z() += lift;
  Carry(before, person);
  return person;
}

std::string NameOf(const GhostSource& ghost) {
  switch (ghost.kind) {
    case GhostSource::Kind::kNPose: return "N-pose";
    case GhostSource::Kind::kTPose: return "T-pose";
    case GhostSource::Kind::kMoment:
      return fmt::format("{}, {} s", std::filesystem::path(ghost.source).filename().string(),
                         ghost.secs);
    case GhostSource::Kind::kNone: break;
  }
  return "";
}

}  // namespace

GhostPose::GhostPose(const GhostValue& ghost, double opacity, const SceneOptions& options)
    : kind_(ghost->kind), opacity_(opacity), name_(NameOf(*ghost)) {
  if (kind_ == GhostSource::Kind::kMoment) recorded_ = ReadMoment(ghost, options);
}

std::vector<Ghost> GhostPose::Make(const SceneState& state) const {
  std::vector<Ghost> ghosts;
  if (kind_ == GhostSource::Kind::kNone) return ghosts;
  if (kind_ == GhostSource::Kind::kMoment) {
    for (const PersonState& person : recorded_) ghosts.push_back({person, opacity_, name_});
    return ghosts;
  }
  for (const PersonState& person : state.people) {
    ghosts.push_back(
        {NeutralPose(person, kind_ == GhostSource::Kind::kTPose, state.floor_z), opacity_, name_});
  }
  return ghosts;
}

}  // namespace kinescope::app
