/// What a user can choose about loads, and what comes from outside beside the samples: plain data.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "server/core/body_forces.h"
#include "server/core/scene_state.h"
#include "server/loads/foot_contact.h"
#include "server/loads/hand_loads.h"
#include "server/loads/joint_score.h"
#include "server/loads/load_classifier.h"
#include "server/loads/motion_filter.h"
#include "server/loads/standing.h"

namespace kinescope::loads {

/// "total", "overload", "external", "norm". @throws UsageError naming the value.
LoadMetric ParseLoadMetric(const std::string& text);

struct LoadSettings {
  LoadMetric metric = LoadMetric::kTotal;
  Strength strength;
  HandLoad hands;
  MotionFilter::Settings motion;
  FootContacts::Settings contact;
  LoadClassifier::Settings classes;
  double most_acceleration = 30;   // m/s^2, of a segment's CoM, joint-loads.md 2.3
  bool clamp_cop = true;           // into the feet; off only for worked examples
  bool compression_counts = true;  // L5/S1 shows the worse of moment and compression
};

/// "" or what is wrong, naming option, value and limits.
std::string FindDefect(const LoadSettings& settings);

/// One joint as another program has it (joint-loads.md 5.7). What is absent is NaN.
struct ExternalJointLoad {
  Eigen::Vector3d moment = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double ratio = std::numeric_limits<double>::quiet_NaN();  // used as given, before the moment
  LoadClass load_class = LoadClass::kUnknown;               // likewise, before the ratio
  std::int64_t stamp_nanos = 0;                             // 0: never
};

/// What came from outside, by the clock of the samples. Counts for kFreshSecs.
struct Measurements {
  std::array<std::optional<MeasuredHandForce>, 2> hands;    // by urdf::Side
  std::array<std::optional<MeasuredGroundForce>, 2> feet;   // likewise; both or none count
  std::optional<MeasuredGroundForce> ground;                // in total
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // by urdf::Joint
};

}  // namespace kinescope::loads
