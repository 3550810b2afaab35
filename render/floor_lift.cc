#include "render/floor_lift.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace kinescope::render {
namespace {

void Lift(PersonState& person, const Eigen::Vector3d& lift) {
  for (urdf::Pose& link : person.links) link.position += lift;
  for (auto& glove : person.gloves) {
    if (!glove) continue;
    for (urdf::Pose& link : glove->links) link.position += lift;
  }
  for (auto& prop : person.props) {
    if (prop) prop->pose.position += lift;
  }
  for (JointLoad& load : person.loads) load.position += lift;
  for (FootForce& foot : person.forces.feet) foot.cop += lift;
  for (HandForce& hand : person.forces.hands) {
    hand.point += lift;
    hand.grip += lift;
  }
  if (person.com) *person.com += lift;
  if (person.cop) *person.cop += lift;
}

void Lift(Camera& camera, const Eigen::Vector3d& lift) {
  camera.position += lift;
  camera.target += lift;
}

void Lift(std::vector<Trail>& trails, std::vector<Ghost>& ghosts, const Eigen::Vector3d& lift) {
  for (Trail& trail : trails) {
    for (Eigen::Vector3d& point : trail.points) point += lift;
  }
  for (Ghost& ghost : ghosts) Lift(ghost.person, lift);
}

void Lift(SceneState& state, const Eigen::Vector3d& lift) {
  for (PersonState& person : state.people) Lift(person, lift);
  for (TrackedObject& object : state.objects) object.pose.position += lift;
  for (RobotState& robot : state.robots) {
    for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(lift);
  }
  for (auto& marker : state.markers) {
    auto lifted = std::make_shared<SceneMarker>(*marker);
    lifted->pose.position += lift;
    marker = std::move(lifted);
  }
  for (auto& image : state.images) {
    if (!image->camera) continue;
    auto lifted = std::make_shared<CameraImage>(*image);
    lifted->camera->world_from_optical.position += lift;
    image = std::move(lifted);
  }
  state.floor_z = 0;
}

Eigen::Vector3d LiftOf(const SceneState& state) { return {0, 0, -state.floor_z}; }

void LiftPane(Pane& pane, const Eigen::Vector3d& of_picture) {
  if (pane.scene == nullptr) return Lift(pane.camera, of_picture);
  const Eigen::Vector3d lift = LiftOf(pane.scene->state);
  Lift(pane.camera, lift);
  auto scene = std::make_shared<PaneScene>(*pane.scene);
  Lift(scene->state, lift);
  Lift(scene->trails, scene->ghosts, lift);
  pane.scene = std::move(scene);
}

}  // namespace

bool IsLifted(const SceneState& state, const PictureSpec& spec) {
  return state.floor_z == 0 &&
         std::all_of(spec.panes.begin(), spec.panes.end(), [](const Pane& pane) {
           return pane.scene == nullptr || pane.scene->state.floor_z == 0;
         });
}

void LiftToFloor(SceneState& state, Camera& camera, PictureSpec& spec) {
  const Eigen::Vector3d lift = LiftOf(state);
  Lift(camera, lift);
  for (Pane& pane : spec.panes) LiftPane(pane, lift);
  Lift(spec.look.trails, spec.look.ghosts, lift);
  Lift(state, lift);
}

}  // namespace kinescope::render
