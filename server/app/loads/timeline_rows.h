/// The rows below the curve of the report's figure over time: contact of the feet, hand load, and
/// when joints are above the upper class limit or unknown. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "core/load_class.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/svg.h"
#include "server/app/loads/trial_intervals.h"

namespace kinescope::app {

/// Seconds of a trial to millimetres of a figure.
struct TimeScale {
  double from = 0, to = 1;      // s; @pre from < to
  double left = 0, right = 10;  // mm
  double X(double secs) const { return left + (secs - from) / (to - from) * (right - left); }
};

enum class RowState { kOff, kOn, kUnknown };

using RowInterval = TrialInterval<RowState>;

struct TimelineRow {
  std::string name;
  LoadClass look = LoadClass::kUnknown;  // of intervals that are on; unknown: plain grey
  std::vector<RowInterval> intervals;
};

/// Feet, hands, and at most eight joints. @pre `trial` keeps its curves
std::vector<TimelineRow> TimelineRowsOf(const LoadTrial& trial);

/// Whether the row has more intervals than can be told apart; heights then are shares of time.
bool ShowsShares(const TimelineRow& row);

inline constexpr double kTimelinePitchMm = 2.75;  // from row to row
/// `top` of the bar, mm. The name is at its left.
void DrawRow(const TimelineRow& row, double top, const TimeScale& scale, SvgDrawing& drawing);

}  // namespace kinescope::app
