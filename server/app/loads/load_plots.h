/// Draws loads over time as plots for papers: one per joint. Colours and
/// limits of the load classes are those of all other outputs; times with unknown loads are hatched.
/// Pure functions except WritePlots; any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>

#include "render/plot.h"
#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"

namespace kinescope::app {

// @pre trials keep their curves

/// The ratio with its classes, and the moment; for L5/S1 also the compression force.
render::Plot JointPlot(const LoadTrial& trial, const TrialContext& context,
                       std::size_t scored_joint);

/// `folder`/right_knee.png, .svg and so on; `folder`/person_1_right_knee.png if there are several
/// people. The folder is created if necessary.
/// @throws std::runtime_error with the path and the reason.
void WritePlots(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                const std::filesystem::path& folder);

}  // namespace kinescope::app
