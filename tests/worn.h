/// Gloves and props for a generated person.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "core/scene_state.h"

namespace kinescope::testing {

/// `bare` with two gloved hands and props 1 and 3. `mesh_folder`: as in HumanModel.
inline std::shared_ptr<const PersonModel> WornModel(const PersonModel& bare,
                                                    const std::string& mesh_folder = "") {
  auto model = std::make_shared<PersonModel>(bare);
  urdf::HumanModel& human = model->human;
  human.mesh_folder = mesh_folder;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    human.gloves[side] = urdf::DefaultHand(side, human.skeleton.finger_tip_in_hand[side].norm());
  }
  human.props = 0b0101;
  model->urdf_xml = urdf::WriteUrdf(human);
  model->robot = urdf::ParseUrdf(model->urdf_xml);
  return model;
}

/// Gives the person `model`, or their own WornModel: fingers bent at every joint by `bend` rad, the
/// props beside the head.
inline void Wear(PersonState& person, double bend = 0.3,
                 std::shared_ptr<const PersonModel> model = nullptr) {
  person.model = model ? std::move(model) : WornModel(*person.model);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    GloveState& glove = person.gloves[side].emplace();
    for (int i = 0; i < urdf::kFingersPerHand; ++i) {
      const bool bends = urdf::KindOf(i) >= urdf::FingerJoint::kKnuckle;
      const double towards_palm = side == urdf::kRight ? bend : -bend;
      glove.angles[urdf::At(i)] = {bends ? towards_palm : 0, 0, 0};
    }
    glove.links =
        urdf::CompleteHand(*person.model->human.gloves[side],
                           person.links[urdf::At(urdf::HandSegmentOf(side))], {}, {}, glove.angles);
  }
  const urdf::Pose& head = person.links[urdf::kHead];
  for (const std::size_t prop : {0u, 2u}) {
    const double y = prop == 0 ? -0.4 : 0.4;
    person.props[prop] = PropState{{head.position + Eigen::Vector3d(0, y, 0.1), head.orientation},
                                   Eigen::Vector3d::Zero()};
  }
}

}  // namespace kinescope::testing
