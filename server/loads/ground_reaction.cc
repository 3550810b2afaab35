#include "server/loads/ground_reaction.h"

#include <limits>

#include "server/loads/support_polygon.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using urdf::kLeft;
using urdf::kRight;
using urdf::Side;

bool HasWeight(const std::array<FootOnGround, 2>& feet) {
  return feet[kRight].weight + feet[kLeft].weight > 0;
}

// Total force and CoP, measured or required. False without foot contact.
bool FindTotal(const GroundReactionInput& input, const MeasuredGroundForce* measured,
               GroundReaction& ground) {
  const Wrench required = RequiredGroundWrench(input.links, input.demand, input.hands);
  if (measured != nullptr) {
    ground.is_measured = true;
    ground.force = measured->only_point ? required.force : measured->force;
    if (measured->only_vertical) ground.force.head<2>() = required.force.head<2>();
    ground.cop = {measured->point.head<2>(), measured->free_moment};
    return !measured->only_point ||
           FindCenterOfPressure(required, input.floor_z, input.mass_kg).has_value();
  }
  ground.force = required.force;
  ground.cop = FindCenterOfPressure(required, input.floor_z, input.mass_kg);
  return ground.cop.has_value();
}

void UseFeet(const std::array<const MeasuredGroundForce*, 2>& feet, GroundReaction& ground) {
  ground.is_measured = true;
  CenterOfPressure cop;
  for (const Side side : {kRight, kLeft}) {
    ground.feet[side] = {feet[side]->force, feet[side]->point.head<2>(), feet[side]->free_moment};
    ground.force += feet[side]->force;
    cop.point += feet[side]->force.z() * feet[side]->point.head<2>();
    cop.free_moment += feet[side]->free_moment;
  }
  if (ground.force.z() <= 0) return;  // no contact of either foot
  cop.point /= ground.force.z();
  for (const Side side : {kRight, kLeft}) {  // moment of the two forces about the common point
    const Vector2d arm = feet[side]->point.head<2>() - cop.point;
    cop.free_moment += arm.x() * feet[side]->force.y() - arm.y() * feet[side]->force.x();
  }
  ground.cop = cop;
}

void PushFeet(const GroundReactionInput& input, const GroundReaction& ground,
              ExternalForces& external) {
  for (const Side side : {kRight, kLeft}) {
    const FootShare& foot = ground.feet[side];
    external.Push(input.links, urdf::FootSegmentOf(side), foot.force,
                  {foot.point.x(), foot.point.y(), input.floor_z}, {0, 0, foot.free_moment});
  }
}

void ShareTotal(const GroundReactionInput& input, GroundReaction& ground) {
  CenterOfPressure cop = *ground.cop;
  cop.point = ground.shown_cop;
  ground.feet = SplitGround(ground.force, cop, input.contacts.feet()).feet;
  if (!input.clamp_cop) return;
  for (const Side side : {kRight, kLeft}) {
    const SupportPolygon& polygon = input.contacts.polygon(side);
    FootShare& foot = ground.feet[side];
    if (polygon.size > 0) foot.point = ClampInto(polygon, foot.point);
  }
}

// Fills everything except the joints.
void FindFloor(const GroundReactionInput& input, const GroundSensors& sensors,
               GroundReaction& ground) {
  const bool feet_are_measured = sensors.feet[kRight] != nullptr && sensors.feet[kLeft] != nullptr;
  if (feet_are_measured) {
    UseFeet(sensors.feet, ground);
    if (!ground.cop) ground.why_not = "no ground reaction force (flight phase)";
  } else if (!FindTotal(input, sensors.total, ground)) {
    ground.why_not = "no ground reaction force (flight phase)";
  } else if (!HasWeight(input.contacts.feet())) {
    ground.why_not = "no foot contact";
  }
  if (!ground.why_not.empty()) {
    ground.force = Vector3d::Zero();
    ground.cop.reset();
    return;
  }
  ground.shown_cop = ground.cop->point;
  const SupportPolygon& support = input.contacts.support();
  if (support.size > 0) {
    ground.cop_inside = DistanceInside(support, ground.cop->point);
    if (input.clamp_cop) ground.shown_cop = ClampInto(support, ground.cop->point);
  }
  if (!feet_are_measured) ShareTotal(input, ground);
}

}  // namespace

GroundReaction SolveGroundReaction(const GroundReactionInput& input, const GroundSensors& sensors) {
  GroundReaction ground;
  ground.cop_inside = std::numeric_limits<double>::quiet_NaN();
  FindFloor(input, sensors, ground);
  ExternalForces external = input.hands;
  if (ground.why_not.empty()) PushFeet(input, ground, external);
  ground.joints = SolveJoints(input.links, input.demand, external);
  return ground;
}

}  // namespace kinescope::loads
