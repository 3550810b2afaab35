#include "server/app/loads/report_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compression_limits.h"
#include "core/system/words.h"
#include "server/app/html.h"
#include "server/app/loads/report_figures.h"
#include "server/app/loads/report_text.h"
#include "server/loads/joint_score.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

constexpr double kMinuteSecs = 60;

std::string CountCells(std::uint64_t part, std::uint64_t all) {
  const char* const zero = part == 0 ? " z" : "";
  return fmt::format("<td class=\"p{0}\">{1}</td><td class=\"c{0}\">{2}</td>", zero,
                     EscapeHtml(PercentText(part, all)), part);
}

// A zero is pale: there is nothing to read.
std::string ZeroCell(double value, int decimals) {
  if (!std::isfinite(value)) return "<td>–</td>";
  if (value == 0) return "<td class=\"z\">0</td>";
  return fmt::format("<td>{:.{}f}</td>", value, decimals);
}

std::string SecsText(double secs) {
  constexpr double kLong = 1000;  // s, where hundredths have no room
  return fmt::format("{:.{}f}", secs, secs < kLong ? 2 : 0);
}

std::string PeakCells(const loads::JointExposure& exposure, const LoadTrial& trial) {
  if (!std::isfinite(exposure.peak_ratio)) {
    return "<td>–</td><td>–</td><td class=\"tx\">–</td>";
  }
  const bool is_over = exposure.peak_ratio > 1;
  return fmt::format("<td{}>{:.2f}{}</td><td>{}</td><td class=\"tx\">{}</td>",
                     is_over ? " class=\"ov\"" : "", exposure.peak_ratio, is_over ? "‡" : "",
                     SecsText(trial.SecsOf(exposure.peak_stamp_nanos)),
                     EscapeHtml(PeakText(exposure, trial)));
}

// Gives way to the counts of long trials.
double BarWidthMm(std::uint64_t samples) {
  constexpr double kWidest = 26, kDigitsOfRow = 4 * 1.42;
  constexpr std::size_t kUsualDigits = 3;
  const std::size_t digits = std::max(kUsualDigits, std::to_string(samples).size());
  return kWidest -
         kDigitsOfRow * static_cast<double>(std::min<std::size_t>(digits, 7) - kUsualDigits);
}

std::string ExposureRow(const LoadTrial& trial, std::size_t joint) {
  const loads::JointExposure exposure = trial.exposure().Of(joint);
  const bool is_high = exposure.samples[static_cast<std::size_t>(LoadClass::kHigh)] > 0;
  const bool begins_group = joint == 3 || joint == 9;  // arms, legs
  std::string row =
      fmt::format("<tr class=\"{}{}\"><th>{}</th><td class=\"b\">{}</td>", is_high ? "hi" : "",
                  begins_group ? " grp" : "", EscapeHtml(ScoredLabel(joint)),
                  ShareBar(exposure, BarWidthMm(trial.samples())));
  for (const LoadClass band : kLoadClassesOfTables) {
    row += CountCells(exposure.samples[static_cast<std::size_t>(band)], trial.samples());
  }
  for (const double ratio : {exposure.p10, exposure.p50, exposure.p90}) {
    row += fmt::format("<td>{}</td>", NumberOrDash(ratio, 2));
  }
  const loads::AboveLimit& above = exposure.above[1];
  if (std::isfinite(exposure.peak_ratio)) {
    row += ZeroCell(above.longest_secs, 2) + ZeroCell(static_cast<double>(above.rises), 0) +
           ZeroCell(above.rises_per_min, above.rises_per_min < 10 ? 1 : 0);
  } else {
    row += "<td>–</td><td>–</td><td>–</td>";
  }
  return row + PeakCells(exposure, trial) + "</tr>\n";
}

std::string ExposureHead(const LoadTrial& trial, const TrialContext& context) {
  const auto& up = context.scene.loads.meter.up;
  return fmt::format(
      "<thead><tr><th></th><th></th><th colspan=\"2\">low<br>≤ {0:g}</th>"
      "<th colspan=\"2\">medium<br>≤ {1:g}</th><th colspan=\"2\">high<br>&gt; {1:g}</th>"
      "<th colspan=\"2\">un-<br>known</th><th>ratio<br>P10</th><th>ratio<br>P50</th>"
      "<th>ratio<br>P90</th><th>longest<br>&gt; {1:g}, s</th><th>rises<br>&gt; {1:g}</th>"
      "<th>per<br>min{2}</th><th>peak<br>ratio</th><th>at,<br>s</th>"
      "<th class=\"tx\">peak by,<br>N·m</th></tr></thead>\n",
      up[0], up[1], trial.secs() < kMinuteSecs ? "†" : "");
}

std::string ExposureLegend(const LoadTrial& trial, const TrialContext& context) {
  std::string legend = "<p class=\"key\">";
  for (const LoadClass band : kLoadClassesOfTables) {
    legend += fmt::format("{} {} &nbsp; ", StateKey(band), Name(band));
  }
  legend += fmt::format(
      "% and number of samples; each row adds up to {}. Percentiles: nearest rank, of the known "
      "ratios. A rise counts again after the ratio was below {:.3g}.",
      Counted(trial.samples(), "sample"), context.scene.loads.meter.down[1]);
  if (trial.secs() > 0 && trial.secs() < kMinuteSecs) {
    legend += fmt::format(" † extrapolated from {:.2f} s.", trial.secs());
  }
  return legend +
         " ‡ above 1: more than the assumed strength; check contact, hand load and strength.</p>\n";
}

// The runs, and the class limit that they are compared at.
struct Comparison {
  const std::vector<SensitivityRow>& rows;
  std::size_t limit = 1;
  std::string what;  // "high", "> 0.3"

  std::uint64_t Above(const SensitivityRow& row, std::size_t joint) const {
    return row.above[limit][joint];
  }
};

Comparison ComparisonOf(const std::vector<SensitivityRow>& rows,
                        const std::array<double, 2>& limits) {
  for (const SensitivityRow& row : rows) {
    for (const std::uint64_t samples : row.above[1]) {
      if (samples > 0) return {rows, 1, "high"};
    }
  }
  return {rows, 0, fmt::format("> {:g},", limits[0])};
}

// Beside L5/S1: known ones with the most samples above the limit.
std::vector<std::size_t> WorstOtherJoints(const Comparison& runs, std::size_t count) {
  const SensitivityRow& computed = runs.rows.front();
  std::vector<std::size_t> joints;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    if (i != urdf::kScoredL5S1 && computed.is_known[i]) joints.push_back(i);
  }
  std::stable_sort(joints.begin(), joints.end(), [&](std::size_t a, std::size_t b) {
    return runs.Above(computed, a) > runs.Above(computed, b);
  });
  if (joints.size() > count) joints.resize(count);
  std::sort(joints.begin(), joints.end());
  return joints;
}

std::string AboveCell(const Comparison& runs, const SensitivityRow& row, std::size_t joint) {
  if (!row.is_known[joint]) return "<td>–</td>";
  return fmt::format("<td>{}</td>", EscapeHtml(PercentText(runs.Above(row, joint), row.samples)));
}

std::string SensitivityCells(const Comparison& runs, const SensitivityRow& row,
                             const std::vector<std::size_t>& others) {
  std::string cells = AboveCell(runs, row, urdf::kScoredL5S1);
  cells += fmt::format("<td>{}</td>", NumberOrDash(row.low_back_p90, 2));
  for (const std::size_t joint : others) cells += AboveCell(runs, row, joint);
  cells += fmt::format(
      "<td>{}</td><td>{}</td>", NumberOrDash(row.peak_compression, 0),
      row.compressions == 0 ? "–" : EscapeHtml(PercentText(row.above_action_limit, row.samples)));
  return cells;
}

// "Right<br>shoulder", "<br>Neck".
std::string NarrowLabel(std::size_t joint) {
  const std::string label(ScoredLabel(joint));
  const std::size_t space = label.find(' ');
  const bool has_side = label.rfind("Right ", 0) == 0 || label.rfind("Left ", 0) == 0;
  if (has_side) return label.substr(0, space) + "<br>" + label.substr(space + 1);
  return "<br>" + EscapeHtml(label.substr(0, space));
}

// What moves the share of L5/S1 most, and whether the compression limit is crossed.
std::string SensitivitySentence(const Comparison& runs) {
  const std::vector<SensitivityRow>& rows = runs.rows;
  const SensitivityRow& computed = rows.front();
  const auto share = [&](const SensitivityRow& row) {
    return 100 * static_cast<double>(runs.Above(row, urdf::kScoredL5S1)) /
           static_cast<double>(std::max<std::uint64_t>(row.samples, 1));
  };
  std::string text =
      "Each further row is a run on the same samples that changes only what it names.";
  const auto most = std::max_element(
      rows.begin(), rows.end(), [&](const SensitivityRow& a, const SensitivityRow& b) {
        return std::abs(share(a) - share(computed)) < std::abs(share(b) - share(computed));
      });
  const double change = share(*most) - share(computed);
  if (std::abs(change) >= 0.05) {
    text += fmt::format(" The share of L5/S1 moves most with {}: {}{:.1f} percentage points.",
                        EscapeHtml(most->label), change < 0 ? "−" : "+", std::abs(change));
  }
  std::size_t above = 0, known = 0;
  for (const SensitivityRow& row : rows) {
    if (row.compressions == 0) continue;
    ++known;
    if (row.peak_compression > kCompressionLimits[0]) ++above;
  }
  if (known > 0) {
    text += fmt::format(" Peak compression is above {:g} N in {} of {} rows.",
                        kCompressionLimits[0], above, known);
  }
  return text;
}

}  // namespace

std::string PeakText(const loads::JointExposure& exposure, const LoadTrial& trial) {
  std::string channel(exposure.peak_channel);
  if (channel == "compression") {
    return fmt::format("compression, {:.0f} N", trial.compression().most);
  }
  if (!std::isfinite(exposure.peak_moment) || !std::isfinite(exposure.peak_capacity))
    return channel;
  return fmt::format("{}, {:.0f} of {:.0f}", channel, std::abs(exposure.peak_moment),
                     exposure.peak_capacity);
}

std::string ExposureTable(const LoadTrial& trial, const TrialContext& context) {
  std::string html = "<table class=\"ex\">\n" + ExposureHead(trial, context) + "<tbody>\n";
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) html += ExposureRow(trial, i);
  return html + "</tbody></table>\n" + ExposureLegend(trial, context);
}

std::string SensitivityTable(const std::vector<SensitivityRow>& rows,
                             const std::array<double, 2>& limits) {
  if (rows.empty()) return "";
  const Comparison runs = ComparisonOf(rows, limits);
  const std::string what = EscapeHtml(runs.what) + " %";
  const std::vector<std::size_t> others = WorstOtherJoints(runs, 2);
  std::string html = fmt::format(
      "<table class=\"se\"><thead><tr><th></th><th>L5/S1<br>{}</th><th>L5/S1<br>P90</th>", what);
  for (const std::size_t joint : others) {
    html += fmt::format("<th>{}<br>{}</th>", NarrowLabel(joint), what);
  }
  html += fmt::format(
      "<th>compr.<br>peak,<br>N</th><th>above<br>{:g} N,<br>%</th></tr></thead><tbody>\n",
      kCompressionLimits[0]);
  for (const SensitivityRow& row : rows) {
    html +=
        fmt::format("<tr{}><th>{}</th>{}</tr>\n", &row == &rows.front() ? " class=\"base\"" : "",
                    EscapeHtml(row.label), SensitivityCells(runs, row, others));
  }
  return html + "</tbody></table>\n<p class=\"sub\">" + SensitivitySentence(runs) + "</p>\n";
}

}  // namespace kinescope::app
