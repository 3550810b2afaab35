#include "core/scene_interpolation.h"

#include <algorithm>
#include <cmath>

namespace kinescope {
namespace {

using Eigen::Vector3d;

std::optional<Vector3d> Between(const std::optional<Vector3d>& a, const std::optional<Vector3d>& b,
                                double t) {
  if (!a || !b) return a;
  return Vector3d((1 - t) * *a + t * *b);
}

// Along with the hands that hold it.
void CarryHeld(const urdf::LinkPoses& before, PersonState& person) {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const int hand = urdf::HandSegmentOf(side);
    const urdf::Pose& was = before[urdf::At(hand)];
    const urdf::Pose& is = person.links[urdf::At(hand)];
    HandForce& held = person.forces.hands[side];
    for (Vector3d* point : {&held.point, &held.grip}) {
      *point =
          is.position + is.orientation * (was.orientation.conjugate() * (*point - was.position));
    }
  }
}

void MoveTowards(PersonState& person, const PersonState& after, double t) {
  const urdf::LinkPoses before = person.links;
  person.links = urdf::Interpolate(person.links, after.links, t);
  for (std::size_t i = 0; i < person.angles.size(); ++i) {
    person.angles[i] = (1 - t) * person.angles[i] + t * after.angles[i];
  }
  for (std::size_t side = 0; side < person.gloves.size(); ++side) {
    if (!person.gloves[side] || !after.gloves[side]) continue;
    GloveState& glove = *person.gloves[side];
    for (std::size_t i = 0; i < glove.links.size(); ++i) {
      glove.links[i] = urdf::Interpolate(glove.links[i], after.gloves[side]->links[i], t);
      glove.angles[i] = (1 - t) * glove.angles[i] + t * after.gloves[side]->angles[i];
    }
  }
  for (std::size_t i = 0; i < person.props.size(); ++i) {
    if (!person.props[i] || !after.props[i]) continue;
    person.props[i]->pose = urdf::Interpolate(person.props[i]->pose, after.props[i]->pose, t);
    Vector3d& angles = person.props[i]->angles;
    angles = (1 - t) * angles + t * after.props[i]->angles;
  }
  CarryHeld(before, person);
  person.com = Between(person.com, after.com, t);
  person.cop = Between(person.cop, after.cop, t);
  for (JointLoad& load : person.loads) {
    load.position = person.links[static_cast<std::size_t>(urdf::ChildOf(load.joint))].position;
  }
}

// Null: they are not in the scene.
const PersonState* FindPerson(const SceneState& scene, int character) {
  const auto found = std::find_if(scene.people.begin(), scene.people.end(),
                                  [&](const PersonState& p) { return p.character == character; });
  return found == scene.people.end() ? nullptr : &*found;
}

// Each person's clock may be another one, so it is that of the person whose sample `before` has.
std::int64_t TimeCodeBetween(const SceneState& before, const SceneState& after, double t) {
  for (const PersonState& person : before.people) {
    const BodySample& sample = person.sample;
    const bool is_newest =
        sample.counter == before.counter && sample.time_code_millis == before.time_code_millis;
    const PersonState* const match = FindPerson(after, person.character);
    if (!is_newest || match == nullptr) continue;
    return std::llround((1 - t) * static_cast<double>(sample.time_code_millis) +
                        t * static_cast<double>(match->sample.time_code_millis));
  }
  return before.time_code_millis;
}

}  // namespace

SceneState Interpolate(const SceneState& before, const SceneState& after,
                       std::int64_t stamp_nanos) {
  if (stamp_nanos <= before.stamp_nanos || after.stamp_nanos <= before.stamp_nanos) return before;
  if (stamp_nanos >= after.stamp_nanos) return after;
  const double t = static_cast<double>(stamp_nanos - before.stamp_nanos) /
                   static_cast<double>(after.stamp_nanos - before.stamp_nanos);
  SceneState scene = before;
  scene.stamp_nanos = stamp_nanos;
  scene.time_code_millis = TimeCodeBetween(before, after, t);
  for (PersonState& person : scene.people) {
    const PersonState* const match = FindPerson(after, person.character);
    if (match != nullptr) MoveTowards(person, *match, t);
  }
  for (TrackedObject& object : scene.objects) {
    const auto match =
        std::find_if(after.objects.begin(), after.objects.end(), [&](const TrackedObject& o) {
          return o.character == object.character && o.number == object.number;
        });
    if (match != after.objects.end()) object.pose = urdf::Interpolate(object.pose, match->pose, t);
  }
  return scene;
}

}  // namespace kinescope
