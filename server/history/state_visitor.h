/// Names what a history keeps of a SceneState, once, for writing and reading: every value that
/// changes from sample to sample and that pictures, page or tables show. What changes seldom is the
/// state's *form* (SameForm); of the rest, see WithoutUnkept().
#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>

#include "core/scene_state.h"

namespace kinescope::history {

// Steps to which values are rounded.
inline constexpr double kMetre = 1e-5, kNewton = 0.1, kRatio = 1e-5, kTurn = 1.0 / 30000;
inline constexpr double kSecond = 1e-3, kHertz = 1e-3, kKilogram = 1e-4;

template <class Column, class Vector>
void VisitVector(Column& column, Vector& v, double step) {
  for (int i = 0; i < v.size(); ++i) column.Number(v[i], step);
}

template <class Column, class Pose>
void VisitPose(Column& column, Pose& pose) {
  VisitVector(column, pose.position, kMetre);
  column.Turn(pose.orientation);
}

template <class Column, class Optional>
void VisitPoint(Column& column, Optional& point) {
  column.Optional(point, [&](auto& v) { VisitVector(column, v, kMetre); });
}

template <class Column, class Load>
void VisitLoad(Column& column, Load& load) {
  VisitVector(column, load.moment, kNewton);
  VisitVector(column, load.force, kNewton);
  column.Number(load.ratio, kRatio);
  column.Number(load.shown_ratio, kRatio);
  column.Number(load.deciding_moment, kNewton / 10);
  column.Number(load.capacity, kNewton / 10);
  column.Text(load.channel);
  column.Whole(load.load_class);
  column.Whole(load.band);
  column.Whole(load.is_of_compression);
  column.Whole(load.is_external);
  for (auto& secs : load.band_secs) column.Number(secs, kSecond);
  column.Text(load.reason);
}

template <class Column, class Forces>
void VisitForces(Column& column, Forces& forces) {
  column.Whole(forces.metric);
  column.Text(forces.why_other_metric);
  column.Whole(forces.is_dynamic);
  column.Text(forces.why_static);
  column.Whole(forces.is_zero_phase);
  column.Number(forces.delay_secs, kSecond);
  column.Number(forces.body_mass_kg, kKilogram);
  column.Whole(forces.body_mass_is_assumed);
  column.Number(forces.floor_z, kMetre);
  column.Text(forces.why_no_floor);
  column.Text(forces.why_no_ground);
  column.Whole(forces.ground_is_measured);
  column.Whole(forces.external_contact_suspected);
  VisitVector(column, forces.ground_force, kNewton);
  for (auto& foot : forces.feet) {
    column.Whole(foot.touches_floor);
    column.Number(foot.contact_weight, kRatio);
    VisitVector(column, foot.force, kNewton);
    VisitVector(column, foot.cop, kMetre);
  }
  column.Whole(forces.support.size);
  for (std::size_t i = 0; i < kMaxSupportPoints; ++i) {
    VisitVector(column, forces.support.corners[i], kMetre);
  }
  column.Optional(forces.margin_of_stability, [&](auto& v) { column.Number(v, kMetre); });
  for (auto& hand : forces.hands) {
    column.Number(hand.mass_kg, kKilogram);
    column.Number(hand.shared_kg, kKilogram);
    VisitVector(column, hand.force, kNewton);
    VisitVector(column, hand.point, kMetre);
    VisitVector(column, hand.grip, kMetre);
    column.Whole(hand.is_measured);
  }
  column.Whole(forces.stated_hand_load.is_known);
  for (auto& mass : forces.stated_hand_load.mass_kg) column.Number(mass, kKilogram);
  column.Number(forces.stated_hand_load.both_kg, kKilogram);
  column.Optional(forces.lumbar, [&](auto& lumbar) {
    column.Number(lumbar.compression, kNewton);
    column.Number(lumbar.shear, kNewton);
    column.Number(lumbar.ratio, kRatio);
  });
  VisitPoint(column, forces.com_minus_mvn);
  column.Whole(forces.com_disagrees);
  column.Number(forces.residual_force_share, kRatio);
  column.Number(forces.residual_moment_share, kRatio);
}

template <class Column, class Person>
void VisitPerson(Column& column, Person& person) {
  for (auto& link : person.links) VisitPose(column, link);
  for (auto& glove : person.gloves) {
    if (!glove) continue;
    for (auto& link : glove->links) VisitPose(column, link);
  }
  for (auto& prop : person.props) {
    if (prop) VisitPose(column, prop->pose);
  }
  VisitPoint(column, person.com);
  column.Whole(person.com_is_ours);
  VisitPoint(column, person.cop);
  for (auto& load : person.loads) VisitLoad(column, load);
  VisitForces(column, person.forces);
}

// Of its links those that are drawn: the others have no place in former states.
template <class Column, class Robot>
void VisitRobot(Column& column, Robot& robot) {
  for (const std::size_t link : LinksToDraw(*robot.model)) {
    auto& world_from_link = robot.world_from_link[link];
    urdf::Pose pose{world_from_link.translation(), Eigen::Quaterniond(world_from_link.linear())};
    VisitPose(column, pose);
    if constexpr (!std::is_const_v<Robot>) {
      world_from_link = Eigen::Translation3d(pose.position) * pose.orientation;
    }
  }
}

template <class Column, class Box>
void VisitExtent(Column& column, Box& extent) {
  std::optional<Eigen::Vector3d> lowest, highest;
  if (!extent.isEmpty()) {
    lowest = extent.min();
    highest = extent.max();
  }
  VisitPoint(column, lowest);
  VisitPoint(column, highest);
  if constexpr (!std::is_const_v<Box>) {
    extent.setEmpty();
    if (lowest && highest) extent = {*lowest, *highest};
  }
}

template <class Column, class State>
void VisitState(Column& column, State& state) {
  column.Whole(state.number);  // the first two: Chunk::Rows
  column.Whole(state.made_nanos);
  column.Whole(state.liveness);
  column.Whole(state.stamp_nanos);
  column.Whole(state.counter);
  column.Whole(state.time_code_millis);
  column.Whole(state.arrival_nanos);
  column.Whole(state.waited_nanos);
  column.Number(state.rate_hz, kHertz);
  column.Number(state.floor_z, kMetre);
  column.Number(state.view_heading, kRatio);
  column.Whole(state.surroundings);
  for (auto& person : state.people) VisitPerson(column, person);
  for (auto& object : state.objects) VisitPose(column, object.pose);
  for (auto& robot : state.robots) VisitRobot(column, robot);
  VisitExtent(column, state.extent);
  column.Optional(state.camera_base, [&](auto& pose) { VisitPose(column, pose); });
}

}  // namespace kinescope::history
