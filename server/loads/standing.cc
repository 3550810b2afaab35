#include "server/loads/standing.h"

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
bool FindTotal(const StandingInput& input, const MeasuredGroundForce* measured,
               Standing& standing) {
  const Wrench required = RequiredGroundWrench(input.links, input.demand, input.hands);
  if (measured != nullptr) {
    standing.is_measured = true;
    standing.force = measured->only_point ? required.force : measured->force;
    if (measured->only_vertical) standing.force.head<2>() = required.force.head<2>();
    standing.cop = {measured->point.head<2>(), measured->free_moment};
    return !measured->only_point ||
           FindCenterOfPressure(required, input.floor_z, input.mass_kg).has_value();
  }
  standing.force = required.force;
  standing.cop = FindCenterOfPressure(required, input.floor_z, input.mass_kg);
  return standing.cop.has_value();
}

void UseFeet(const std::array<const MeasuredGroundForce*, 2>& feet, Standing& standing) {
  standing.is_measured = true;
  CenterOfPressure cop;
  for (const Side side : {kRight, kLeft}) {
    standing.feet[side] = {feet[side]->force, feet[side]->point.head<2>(), feet[side]->free_moment};
    standing.force += feet[side]->force;
    cop.point += feet[side]->force.z() * feet[side]->point.head<2>();
    cop.free_moment += feet[side]->free_moment;
  }
  if (standing.force.z() <= 0) return;  // no contact of either foot
  cop.point /= standing.force.z();
  for (const Side side : {kRight, kLeft}) {  // moment of the two forces about the common point
    const Vector2d arm = feet[side]->point.head<2>() - cop.point;
    cop.free_moment += arm.x() * feet[side]->force.y() - arm.y() * feet[side]->force.x();
  }
  standing.cop = cop;
}

void PushFeet(const StandingInput& input, const Standing& standing, ExternalForces& external) {
  for (const Side side : {kRight, kLeft}) {
    const FootShare& foot = standing.feet[side];
    external.Push(input.links, urdf::FootSegmentOf(side), foot.force,
                  {foot.point.x(), foot.point.y(), input.floor_z}, {0, 0, foot.free_moment});
  }
}

void ShareTotal(const StandingInput& input, Standing& standing) {
  CenterOfPressure cop = *standing.cop;
  cop.point = standing.shown_cop;
  standing.feet = SplitGround(standing.force, cop, input.contacts.feet()).feet;
  if (!input.clamp_cop) return;
  for (const Side side : {kRight, kLeft}) {
    const SupportPolygon& polygon = input.contacts.polygon(side);
    FootShare& foot = standing.feet[side];
    if (polygon.size > 0) foot.point = ClampInto(polygon, foot.point);
  }
}

// Fills everything except the joints.
void FindFloor(const StandingInput& input, const GroundSensors& sensors, Standing& standing) {
  const bool feet_are_measured = sensors.feet[kRight] != nullptr && sensors.feet[kLeft] != nullptr;
  if (feet_are_measured) {
    UseFeet(sensors.feet, standing);
    if (!standing.cop) standing.why_not = "no ground reaction force (flight phase)";
  } else if (!FindTotal(input, sensors.total, standing)) {
    standing.why_not = "no ground reaction force (flight phase)";
  } else if (!HasWeight(input.contacts.feet())) {
    standing.why_not = "no foot contact";
  }
  if (!standing.why_not.empty()) {
    standing.force = Vector3d::Zero();
    standing.cop.reset();
    return;
  }
  standing.shown_cop = standing.cop->point;
  const SupportPolygon& support = input.contacts.support();
  if (support.size > 0) {
    standing.cop_inside = DistanceInside(support, standing.cop->point);
    if (input.clamp_cop) standing.shown_cop = ClampInto(support, standing.cop->point);
  }
  if (!feet_are_measured) ShareTotal(input, standing);
}

}  // namespace

Standing SolveStanding(const StandingInput& input, const GroundSensors& sensors) {
  Standing standing;
  standing.cop_inside = std::numeric_limits<double>::quiet_NaN();
  FindFloor(input, sensors, standing);
  ExternalForces external = input.hands;
  if (standing.why_not.empty()) PushFeet(input, standing, external);
  standing.joints = SolveJoints(input.links, input.demand, external);
  return standing;
}

}  // namespace kinescope::loads
