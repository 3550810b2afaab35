#include "render/floor_lift.h"

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

}  // namespace

void LiftToFloor(SceneState& state, Camera& camera, PictureSpec& spec) {
  const Eigen::Vector3d lift(0, 0, -state.floor_z);
  const auto raise = [&](Camera& each) {
    each.position += lift;
    each.target += lift;
  };
  raise(camera);
  for (Pane& pane : spec.panes) raise(pane.camera);
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
  for (Trail& trail : spec.look.trails) {
    for (Eigen::Vector3d& point : trail.points) point += lift;
  }
  for (Ghost& ghost : spec.look.ghosts) Lift(ghost.person, lift);
  state.floor_z = 0;
}

}  // namespace kinescope::render
