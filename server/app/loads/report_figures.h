/// Draws the figures of the report as inline SVG. Black, greys and patterns carry the meaning, so a
/// grey copy says the same. Pure functions; any thread.
#pragma once

#include <string>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/loads/exposure.h"

namespace kinescope::app {

// @pre trials keep their curves

/// Over one time axis: compression at L5/S1 with its uncertainty and both limits, contact of the
/// feet, hand load, and when the joints are above the upper class limit or unknown.
/// @pre height_mm >= 45
std::string TimeFigure(const LoadTrial& trial, const TrialContext& context, double height_mm);

/// Share of the known samples at or below a ratio (amplitude probability distribution function):
/// nine panels, right and left in one.
std::string DistributionFigure(const LoadTrial& trial, const TrialContext& context);

/// The shares of a joint in the classes, as one bar.
std::string ShareBar(const loads::JointExposure& exposure, double width_mm);
/// A sample of a class for the legend.
std::string StateKey(LoadClass load_class);

inline constexpr double kTimeFigureWidthMm = 100;
inline constexpr double kDistributionWidthMm = 186;

}  // namespace kinescope::app
