/// The tables of the report as HTML: exposure of every joint, and how the answer depends on
/// assumptions. Pure functions; any thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/sensitivity.h"

namespace kinescope::app {

/// With its legend. Shares are of all samples, so that counts and percents add up.
std::string ExposureTable(const LoadTrial& trial, const TrialContext& context);

/// `rows`: the first is the trial itself; `limits`: of the classes. Shares above the upper limit,
/// or the lower one if no run is ever above the upper. With a sentence on what matters most. ""
/// without rows.
std::string SensitivityTable(const std::vector<SensitivityRow>& rows,
                             const std::array<double, 2>& limits);

/// "extension, 200 of 234"; of a compression the force.
std::string PeakText(const loads::JointExposure& exposure, const LoadTrial& trial);

}  // namespace kinescope::app
