/// A person to publish: the default body in a posture of our choice, with loads of every class.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "core/scene_state.h"

namespace kinescope::testing {

/// The same value for the same arguments: tests ask for it for every message, and writing and
/// reading a URDF takes long.
inline std::shared_ptr<const PersonModel> MakeModel(const std::string& name = "skeleton",
                                                    double height_m = 1.75,
                                                    std::uint64_t revision = 1) {
  static std::map<std::tuple<std::string, double, std::uint64_t>,
                  std::shared_ptr<const PersonModel>>
      made;
  std::shared_ptr<const PersonModel>& known = made[{name, height_m, revision}];
  if (!known) {
    auto model = std::make_shared<PersonModel>();
    model->human.model_name = name;
    model->human.skeleton = urdf::DefaultSkeleton(height_m);
    model->human.body = urdf::MakeBodyParameters(model->description, model->human.skeleton);
    model->urdf_xml = urdf::WriteUrdf(model->human);
    model->robot = urdf::ParseUrdf(model->urdf_xml);
    model->revision = revision;
    known = std::move(model);
  }
  return known;
}

/// Angles that no two joints or axes share, all well within +-90 deg; they change with `phase`.
inline urdf::JointAngles Posture(double phase) {
  urdf::JointAngles angles;
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      angles[static_cast<std::size_t>(joint)][axis] =
          0.25 * std::sin(phase + 0.7 * joint + 2.1 * axis) + 0.01 * joint;
    }
  }
  return angles;
}

inline PersonState MakePerson(std::shared_ptr<const PersonModel> model,
                              const urdf::JointAngles& angles, std::uint32_t counter,
                              std::int64_t stamp_nanos) {
  PersonState person;
  person.model = std::move(model);
  person.angles = angles;
  const urdf::Pose pelvis{{0.3, -0.2, 0.99},
                          Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()))};
  person.links = urdf::ForwardKinematics(person.model->human.skeleton, pelvis, angles);
  person.sample.counter = counter;
  person.sample.stamp_nanos = stamp_nanos;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const auto i = static_cast<std::size_t>(segment);
    SegmentState& state = person.sample.segments[i];
    state.position = person.links[i].position;
    state.orientation = person.links[i].orientation * urdf::SegmentFromLink(segment).conjugate();
    state.velocity = {0.1 * segment, 0.2, 0.3};
    state.acceleration = {1.0, 0.1 * segment, 3.0};
    state.angular_velocity = {4.0, 5.0, 0.1 * segment};
    state.angular_acceleration = {0.1 * segment, 8.0, 9.0};
  }
  person.com = Eigen::Vector3d(0.31, -0.19, 1.02);
  person.cop = Eigen::Vector3d(0.33, -0.18, 0);
  for (int joint : {urdf::jL5S1, urdf::jRightShoulder, urdf::jLeftShoulder, urdf::jRightElbow,
                    urdf::jRightHip, urdf::jLeftHip, urdf::jRightKnee, urdf::jLeftKnee}) {
    JointLoad load;
    load.joint = joint;
    load.position = person.links[static_cast<std::size_t>(urdf::ChildOf(joint))].position;
    load.moment = {1.0 + joint, -2.0, 0.5 * joint};
    load.load_class = static_cast<LoadClass>(joint % 4);
    person.loads.push_back(load);
  }
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    JointForce& force = person.forces.joints[static_cast<std::size_t>(joint)];
    force.moment = {1.0 + joint, -2.0, 0.5 * joint};
    if (joint % 4 == 0) force.why_unknown = "no foot contact";
  }
  return person;
}

/// MakeModel's person with gloves on and two props.
inline std::shared_ptr<const PersonModel> MakeGlovedModel(const std::string& name = "skeleton") {
  auto model = std::make_shared<PersonModel>(*MakeModel(name));
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const double length = model->human.skeleton.finger_tip_in_hand[side].norm();
    model->human.gloves[side] = urdf::DefaultHand(side, length);
  }
  model->human.props = 0b0011;
  model->urdf_xml = urdf::WriteUrdf(model->human);
  model->revision += 1;
  return model;
}

/// Fingers and props of a person of that model: as rigid as the URDF, wherever `phase` bends them.
inline void BendFingers(double phase, PersonState& person) {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    GloveState& glove = person.gloves[side].emplace();
    for (std::size_t i = 0; i < glove.angles.size(); ++i) {
      const double at = phase + static_cast<double>(i);
      glove.angles[i] = {std::sin(at), 0.2 * std::cos(at), 0.1 * std::sin(2 * at)};
    }
    glove.links = urdf::CompleteHand(
        *person.model->human.gloves[side],
        person.links[static_cast<std::size_t>(urdf::HandSegmentOf(side))], {}, {}, glove.angles);
  }
  const urdf::Pose& pelvis = person.links[urdf::kPelvis];
  for (std::size_t i = 0; i < 2; ++i) {
    PropState& prop = person.props[i].emplace();
    prop.angles = {0.3, 0.2 + phase, -0.4};
    prop.pose.position = pelvis.position + Eigen::Vector3d(0.5, -0.1, 0.2 * std::sin(phase));
    prop.pose.orientation = pelvis.orientation * urdf::RotationFromAngles(prop.angles);
  }
}

inline SceneState SceneWith(PersonState person) {
  SceneState state;
  state.liveness = Liveness::kLive;
  state.number = person.sample.counter;
  state.counter = person.sample.counter;
  state.stamp_nanos = person.sample.stamp_nanos;
  state.people.push_back(std::move(person));
  return state;
}

}  // namespace kinescope::testing
