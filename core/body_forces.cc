#include "core/body_forces.h"

#include "core/unknown.h"

namespace kinescope {

const char* Name(LoadMetric metric) {
  switch (metric) {
    case LoadMetric::kOverload: return "overload";
    case LoadMetric::kExternal: return "external";
    case LoadMetric::kNorm: return "norm";
    case LoadMetric::kTotal: break;
  }
  return "total";
}

const char* FilterName(const BodyForces& forces) {
  if (!forces.is_dynamic) return "";
  return forces.is_zero_phase ? "zero-phase" : "causal";
}

void MakeUnknown(std::string_view why, BodyForces& forces) {
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(kUnknown);
  forces.joints.fill({nothing, nothing, why});
  forces.why_no_ground = why;
  forces.ground_is_measured = forces.external_contact_suspected = false;
  forces.ground_force = Eigen::Vector3d::Zero();
  forces.ground_free_moment = 0;
  forces.cop_inside = kUnknown;
  for (FootForce& foot : forces.feet) {
    foot.force = foot.cop = nothing;
    foot.free_moment = kUnknown;
  }
  forces.extrapolated_com.reset();
  forces.margin_of_stability.reset();
  forces.lumbar.reset();
}

}  // namespace kinescope
