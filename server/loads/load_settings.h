/// User settings of the load computation: plain data, any thread.
#pragma once

#include <array>
#include <string>

#include "core/body_forces.h"
#include "core/force_inputs.h"
#include "server/loads/foot_contact.h"
#include "server/loads/ground_reaction.h"
#include "server/loads/hand_loads.h"
#include "server/loads/joint_score.h"
#include "server/loads/load_meter.h"
#include "server/loads/motion_filter.h"

namespace kinescope::loads {

using kinescope::ExternalJointLoad;
using kinescope::Measurements;

struct LoadSettings {
  LoadMetric metric = LoadMetric::kTotal;
  Strength strength;
  HandLoad hands;
  MotionFilter::Settings motion;
  FootContacts::Settings contact;
  LoadMeter::Settings meter;
  double most_acceleration = 300;  // m/s^2, of a segment's CoM, more than in a kick
  bool clamp_cop = true;           // to the feet; off only for worked examples
  bool compression_counts = true;  // L5/S1 shows the higher of moment and compression
};

/// Why `settings` is invalid, with option, value and limits; "" if they are valid.
[[nodiscard]] std::string FindDefect(const LoadSettings& settings);

}  // namespace kinescope::loads
