/// What the floor does to the feet, and what the joints carry then: one solve for one set of forces
/// on the hands. Pure function; any thread; no allocation.
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

/// What is fresh of what was measured; null: nothing is.
struct GroundSensors {
  std::array<const MeasuredGroundForce*, 2> feet{};  // by urdf::Side; both or none count
  const MeasuredGroundForce* total = nullptr;
};

struct StandingInput {
  const urdf::LinkPoses& links;
  const BodyDemand& demand;
  const ExternalForces& hands;  // and whatever else pushes, but not the floor
  const FootContacts& contacts;
  double floor_z = 0;  // world, m
  double mass_kg = 0;  // of the body
  bool clamp_cop = true;
};

struct Standing {
  JointWrenches joints;
  std::string_view why_not;  // nothing can be said about the floor; "" otherwise
  bool is_measured = false;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, of the floor; zero when nothing is known
  std::optional<CenterOfPressure> cop;              // before it is clamped
  Eigen::Vector2d shown_cop = Eigen::Vector2d::Zero();  // after
  double cop_inside = 0;  // m, of the unclamped one, positive inside the support; NaN: unknown
  std::array<FootShare, 2> feet;
};

/// Measured forces take precedence: those of both feet, else the total one, else what the motion
/// requires. A foot's CoP is clamped into the foot last, which leaves a small residual.
Standing SolveStanding(const StandingInput& input, const GroundSensors& sensors);

}  // namespace kinescope::loads
