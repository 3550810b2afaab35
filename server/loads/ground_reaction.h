/// Computes the ground reaction forces and the joint loads for one set of hand forces. Pure
/// function; any thread; no allocation. World frame, metres, newtons, N·m.
/// Source: joint-loads.md 2.4 to 2.6.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/force_inputs.h"
#include "server/loads/foot_contact.h"
#include "server/loads/ground.h"
#include "server/loads/inverse_dynamics.h"

namespace kinescope::loads {

using kinescope::MeasuredGroundForce;

/// The valid (not expired) ground measurements; null: none.
struct GroundSensors {
  std::array<const MeasuredGroundForce*, 2> feet{};  // by urdf::Side; used only if both are present
  const MeasuredGroundForce* total = nullptr;
};

struct GroundReactionInput {
  const urdf::LinkPoses& links;
  const BodyDemand& demand;
  const ExternalForces& hands;  // all external forces except those of the floor
  const FootContacts& contacts;
  double floor_z = 0;  // world, m
  double mass_kg = 0;  // body mass
  bool clamp_cop = true;
};

struct GroundReaction {
  JointWrenches joints;
  std::string_view why_not;  // why the ground reaction force is unknown; "" otherwise
  bool is_measured = false;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      // ground reaction force, N; zero if unknown
  std::optional<CenterOfPressure> cop;                  // before clamping
  Eigen::Vector2d shown_cop = Eigen::Vector2d::Zero();  // after clamping, world, m
  double cop_inside = 0;  // m, of the CoP before clamping, positive inside the support polygon;
                          // NaN: unknown
  std::array<FootShare, 2> feet;
};

/// Measured forces take precedence: those of both feet, else the total, else the force that the
/// motion requires. The CoP of a foot is clamped into the foot last, which leaves a small residual.
GroundReaction SolveGroundReaction(const GroundReactionInput& input, const GroundSensors& sensors);

}  // namespace kinescope::loads
