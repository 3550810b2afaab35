#include "server/app/loads/timeline_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

constexpr double kRowBar = 1.9;  // mm
constexpr std::size_t kMostJointRows = 8;
constexpr Rgb kBarInk = {0.52, 0.56, 0.62}, kShareInk = {0.80, 0.82, 0.84},
              kEdgeInk = {0.34, 0.36, 0.40};

TimelineRow JointRow(const LoadTrial& trial, std::size_t joint) {
  std::string name(ScoredLabel(joint));
  const auto replace = [&](std::string_view long_word, std::string_view short_word) {
    const std::size_t at = name.find(long_word);
    if (at != std::string::npos) name.replace(at, long_word.size(), short_word);
  };
  replace("Right ", "R ");
  replace("Left ", "L ");
  replace(" (T1/C7)", "");
  return {std::move(name), LoadClass::kHigh,
          IntervalsOf(trial, RowState::kUnknown, [joint](const TrialSample& sample) {
            const LoadClass band = sample.joints[joint].band;
            return band == LoadClass::kUnknown ? RowState::kUnknown
                   : band == LoadClass::kHigh  ? RowState::kOn
                                               : RowState::kOff;
          })};
}

void AddFootRows(const LoadTrial& trial, std::vector<TimelineRow>& rows) {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    rows.push_back({side == urdf::kRight ? "R foot" : "L foot", LoadClass::kUnknown,
                    IntervalsOf(trial, RowState::kUnknown, [side](const TrialSample& sample) {
                      if (!sample.is_ground_known) return RowState::kUnknown;
                      return sample.foot_on_floor[static_cast<std::size_t>(side)] ? RowState::kOn
                                                                                  : RowState::kOff;
                    })});
  }
}

void AddHandRow(const LoadTrial& trial, std::vector<TimelineRow>& rows) {
  constexpr float kLeastKg = 0.05F;
  float most = 0;
  for (const TrialSample& sample : trial.curves()) most = std::max(most, sample.hands_kg);
  if (most < kLeastKg) return;
  rows.push_back({fmt::format("hands {:.3g} kg", most), LoadClass::kUnknown,
                  IntervalsOf(trial, RowState::kUnknown, [](const TrialSample& sample) {
                    return sample.hands_kg >= kLeastKg ? RowState::kOn : RowState::kOff;
                  })});
}

// Those that are ever high, the ones with the most samples if there is no room for all, in their
// usual order. If no row shows an unknown load, the joints without a row share one for theirs.
void AddJointRows(const LoadTrial& trial, std::vector<TimelineRow>& rows) {
  std::vector<std::pair<std::uint64_t, std::size_t>> high;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const std::uint64_t samples =
        trial.exposure().Of(i).samples[static_cast<std::size_t>(LoadClass::kHigh)];
    if (samples > 0) high.emplace_back(samples, i);
  }
  std::stable_sort(high.begin(), high.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (high.size() > kMostJointRows) high.resize(kMostJointRows);
  std::array<bool, urdf::kScoredJointCount> has_row{};
  for (const auto& [samples, joint] : high) has_row[joint] = true;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    if (has_row[i]) rows.push_back(JointRow(trial, i));
  }
  TimelineRow others{high.empty() ? "unknown" : "others", LoadClass::kHigh,
                     IntervalsOf(trial, RowState::kUnknown, [&](const TrialSample& sample) {
                       for (std::size_t i = 0; i < sample.joints.size(); ++i) {
                         if (!has_row[i] && sample.joints[i].band == LoadClass::kUnknown) {
                           return RowState::kUnknown;
                         }
                       }
                       return RowState::kOff;
                     })};
  const auto is_ever_unknown = [](const TimelineRow& row) {
    return std::any_of(row.intervals.begin(), row.intervals.end(),
                       [](const RowInterval& each) { return each.state == RowState::kUnknown; });
  };
  const bool is_shown = std::any_of(rows.begin(), rows.end(), is_ever_unknown);
  if (!is_shown && is_ever_unknown(others)) rows.push_back(std::move(others));
}

// Each interval as it is.
void DrawIntervals(const TimelineRow& row, double top, const TimeScale& scale,
                   SvgDrawing& drawing) {
  constexpr double kThinnest = 0.25;  // mm, so that a single sample is seen
  for (const RowInterval& interval : row.intervals) {
    if (interval.state == RowState::kOff) continue;
    const double from = scale.X(interval.from);
    const double width = std::max(scale.X(interval.to) - from, kThinnest);
    const SvgBox box = {from, top, width, kRowBar};
    if (interval.state == RowState::kUnknown) {
      DrawState(box, LoadClass::kUnknown, drawing);
      drawing.Outline(box, {kEdgeInk, 0.1, ""});
    } else if (row.look == LoadClass::kUnknown) {
      drawing.Fill(box, kBarInk);
    } else {
      DrawState(box, row.look, drawing);
    }
  }
}

// More intervals than can be told apart: the height is the share of the time, from the bottom; that
// of unknown loads hangs from the top.
void DrawShares(const TimelineRow& row, double top, const TimeScale& scale, SvgDrawing& drawing) {
  constexpr std::size_t kColumns = 200;
  constexpr double kLowest = 0.3;  // mm, of any time at all
  const double pitch = (scale.to - scale.from) / kColumns;
  std::array<double, kColumns> on{}, unknown{};  // s
  for (const RowInterval& interval : row.intervals) {
    if (interval.state == RowState::kOff) continue;
    std::array<double, kColumns>& secs = interval.state == RowState::kOn ? on : unknown;
    const double from = (interval.from - scale.from) / pitch,
                 to = (interval.to - scale.from) / pitch;
    for (auto i = static_cast<std::size_t>(from); i < kColumns && static_cast<double>(i) < to;
         ++i) {
      const double begin = std::max(from, static_cast<double>(i));
      secs[i] += (std::min(to, static_cast<double>(i + 1)) - begin) * pitch;
    }
  }
  constexpr double kOverlap = 0.03;  // no gaps between columns
  const double width = (scale.right - scale.left) / kColumns;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const double left = scale.left + static_cast<double>(i) * width;
    const auto height = [&](double secs) {
      return std::max(kLowest, kRowBar * std::min(1.0, secs / pitch));
    };
    if (unknown[i] > 0) drawing.Fill({left, top, width + kOverlap, height(unknown[i])}, kShareInk);
    if (on[i] <= 0) continue;
    const double tall = height(on[i]);
    drawing.Fill({left, top + kRowBar - tall, width + kOverlap, tall},
                 row.look == LoadClass::kUnknown ? kBarInk : ColorOf(row.look));
  }
}

}  // namespace

std::vector<TimelineRow> TimelineRowsOf(const LoadTrial& trial) {
  std::vector<TimelineRow> rows;
  AddFootRows(trial, rows);
  AddHandRow(trial, rows);
  AddJointRows(trial, rows);
  return rows;
}

bool ShowsShares(const TimelineRow& row) {
  constexpr std::size_t kMost = 200;
  return row.intervals.size() > kMost;
}

void DrawRow(const TimelineRow& row, double top, const TimeScale& scale, SvgDrawing& drawing) {
  drawing.Text(scale.left - 1, top + kRowBar, row.name, {SvgAnchor::kEnd});
  if (ShowsShares(row)) {
    DrawShares(row, top, scale, drawing);
  } else {
    DrawIntervals(row, top, scale, drawing);
  }
}

}  // namespace kinescope::app
