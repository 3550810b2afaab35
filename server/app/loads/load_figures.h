/// Loads over time as figures for papers: one for each joint, and all of them on one. The classes'
/// colours and limits are those of everywhere else; times nothing is known of are hatched. Pure
/// functions but for WritePlots; any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>

#include "render/plot.h"
#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"

namespace kinescope::app {

// @pre trials keep their curves

/// Ratio with its classes, and the moment; of L5/S1 its compression as well.
render::Figure JointFigure(const LoadTrial& trial, const TrialContext& context,
                           std::size_t scored_joint);

/// The ratios of all joints and the compression of L5/S1, small, on one scale; as wide as the text
/// of an A4 page.
render::Figure OverviewFigure(const LoadTrial& trial, const TrialContext& context);

/// `folder`/right_knee.png, .svg and so on, `folder`/person_1_right_knee.png where there are
/// several people. The folder is made where it is not there.
/// @throws std::runtime_error naming the path and the reason.
void WritePlots(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                const std::filesystem::path& folder);

}  // namespace kinescope::app
