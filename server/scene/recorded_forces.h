/// Gives the samples of one person the measured forces of a file (docs/loads.md), as a robot's
/// sensors would over ROS. The result depends only on samples and file. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/body_sample.h"
#include "core/force_inputs.h"
#include "server/wrenches/wrench_track.h"
#include "urdf/kinematics.h"

namespace kinescope::app {

class RecordedForces {
 public:
  /// `rate_hz`: of the samples; 0: unknown, 60 is used.
  /// @throws SourceError, UsageError as wrenches::WrenchTrack
  RecordedForces(const wrenches::WrenchSettings& settings, double rate_hz);

  /// Whether the forces are those of the person of `sample`. Call it for every sample: the first
  /// one is time 0, and its person is that of the forces.
  bool AreOf(const BodySample& sample);

  /// What the file has for the time of `sample`, whose poses are `links`. `floor_z`: of the floor,
  /// world, m. Outside the file and in its gaps, ground forces are absent; those of hands have
  /// expired, so that loads are unknown there.
  /// @throws SourceError if a force acts far from its hand
  /// @pre AreOf(sample)
  Measurements At(const BodySample& sample, const urdf::LinkPoses& links, double floor_z);

 private:
  wrenches::WrenchTrack track_;
  const double period_secs_;
  std::optional<int> character_;  // set with the first sample
  std::int64_t begin_nanos_ = 0;  // set with the first sample
  std::array<Eigen::Vector3d, wrenches::kWrenchBodyCount> last_points_;  // centres of pressure
};

}  // namespace kinescope::app
