// The two forms of a summary: text for the terminal, JSON for other programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compression_limits.h"
#include "core/system/utf8.h"
#include "server/app/loads/load_summary.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

json NumberOrNull(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

std::string RatioText(double value) {
  return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-";
}

// "flexion 12.3 of 61.7 N·m".
std::string DirectionText(const JointSummary::PeakRatio& peak) {
  if (!std::isfinite(peak.moment)) return std::string(peak.channel);
  return fmt::format("{} {:.1f} of {:.1f} N·m", peak.channel, std::abs(peak.moment), peak.capacity);
}

std::string ShareText(std::uint64_t part, std::uint64_t all) {
  if (all == 0) return "-";
  return fmt::format("{:.1f} %", 100 * static_cast<double>(part) / static_cast<double>(all));
}

std::string JointLine(std::string_view label, const JointSummary& joint, std::uint64_t all) {
  const std::uint64_t unknown = joint.samples[static_cast<std::size_t>(LoadClass::kUnknown)];
  const auto percent = [&](LoadClass band) {
    const std::uint64_t samples = joint.samples[static_cast<std::size_t>(band)];
    return ShareText(samples, band == LoadClass::kUnknown ? all : all - unknown);
  };
  const loads::AboveLimit& high = joint.above[1];
  return fmt::format(
      "{:<15}{:>8}{:>8}{:>8}{:>8}{:>7}{:>6}{:>6}{:>7}{:>9}{:>9}{:>6}  {}\n", label,
      percent(LoadClass::kLow), percent(LoadClass::kMedium), percent(LoadClass::kHigh),
      percent(LoadClass::kUnknown), RatioText(joint.p10), RatioText(joint.p50),
      RatioText(joint.p90), joint.peak ? RatioText(joint.peak->ratio) : "-",
      joint.peak ? fmt::format("{:.2f} s", joint.peak->at_secs) : "-",
      joint.peak ? fmt::format("{:.2f} s", high.longest_secs) : "-",
      joint.peak ? std::to_string(high.rises) : "-", joint.peak ? DirectionText(*joint.peak) : "");
}

json JointJson(std::string_view name, const JointSummary& joint,
               const std::array<double, 2>& limits) {
  json secs = json::object(), samples = json::object(), why = json::object();
  for (std::size_t i = 0; i < joint.secs.size(); ++i) {
    const char* const band = kinescope::Name(static_cast<LoadClass>(i));
    secs[band] = joint.secs[i];
    samples[band] = joint.samples[i];
  }
  for (const auto& [reason, reason_secs] : joint.why_unknown) {
    why[std::string(reason)] = reason_secs;
  }
  json above = json::array();
  for (std::size_t i = 0; i < joint.above.size(); ++i) {
    above.push_back({{"limit", limits[i]},
                     {"longest_s", joint.above[i].longest_secs},
                     {"rises", joint.above[i].rises},
                     {"rises_per_min", NumberOrNull(joint.above[i].rises_per_min)}});
  }
  json out = {{"joint", name},
              {"samples", samples},
              {"seconds", secs},
              {"above", above},
              {"p10", NumberOrNull(joint.p10)},
              {"p50", NumberOrNull(joint.p50)},
              {"p90", NumberOrNull(joint.p90)},
              {"unknown", why}};
  for (const char* key :
       {"peak_ratio", "peak_time_s", "peak_channel", "peak_moment_Nm", "peak_capacity_Nm"}) {
    out[key] = nullptr;
  }
  if (joint.peak) {
    out["peak_ratio"] = joint.peak->ratio;
    out["peak_time_s"] = joint.peak->at_secs;
    out["peak_channel"] = joint.peak->channel;
    out["peak_moment_Nm"] = NumberOrNull(joint.peak->moment);
    out["peak_capacity_Nm"] = NumberOrNull(joint.peak->capacity);
  }
  return out;
}

json MarkJson(const TrialSummary::MarkSummary& each) {
  const TrialMark& mark = each.mark;
  const auto& highest = each.loads.highest;
  return {{"from_s", mark.from_secs},
          {"to_s", mark.to_secs},
          {"is_span", mark.is_span},
          {"kind", mark.is_change ? "change" : "mark"},
          {"button", mark.button},
          {"text", mark.text},
          {"role", mark.role},
          {"window_from_s", each.loads.from_secs},
          {"window_to_s", each.loads.to_secs},
          {"joint", highest ? json(ScoredName(highest->joint)) : json(nullptr)},
          {"ratio", highest ? json(highest->ratio) : json(nullptr)},
          {"ratio_time_s", highest ? json(highest->at_secs) : json(nullptr)},
          {"l5_s1_compression_N",
           each.loads.compression_N ? json(*each.loads.compression_N) : json(nullptr)}};
}

json ValueJson(const std::optional<ValueSummary>& value) {
  if (!value) return nullptr;
  return {{"mean", value->mean}, {"most", value->most}, {"most_at_s", value->most_at_secs}};
}

json CompressionJson(const TrialSummary& summary) {
  json value = ValueJson(summary.compression);
  if (value.is_null()) return value;
  json above = json::array();
  for (std::size_t i = 0; i < summary.compression_secs.size(); ++i) {
    above.push_back({{"limit", kCompressionLimits[i]}, {"seconds", summary.compression_secs[i]}});
  }
  value["above"] = above;
  return value;
}

}  // namespace

std::string SummaryText(const TrialSummary& summary) {
  std::string text = fmt::format("{}, {}: {} samples, {:.2f} s\n", PrintableLine(summary.source),
                                 PrintableLine(summary.title), summary.samples, summary.secs);
  for (const Fact& fact : summary.facts) {
    text +=
        fmt::format("  {:<14} {}{}\n", fact.label, fact.value, fact.is_assumed ? " (assumed)" : "");
  }
  text += fmt::format("\n{:<15}{:>8}{:>8}{:>8}{:>8}{:>7}{:>6}{:>6}{:>7}{:>9}{:>9}{:>6}  {}\n",
                      "joint", "low", "medium", "high", "unknown", "p10", "p50", "p90", "peak",
                      "at", "longest", "rises", "direction");
  for (std::size_t i = 0; i < summary.joints.size(); ++i) {
    text += JointLine(ScoredLabel(i), summary.joints[i], summary.samples);
  }
  text += fmt::format(
      "Shares of the samples in which the load is known, with a ratio up to {0:g}, up to {1:g} and "
      "above; longest: longest time above {1:g}; rises: how often the ratio rose above it.\n",
      summary.limits[0], summary.limits[1]);
  if (!summary.marks.empty())
    text += "\nMarks, with the highest load and L5/S1 compression around:\n";
  constexpr std::size_t kMostMarks = 40;
  const std::size_t shown = std::min(summary.marks.size(), kMostMarks);
  for (std::size_t i = 0; i < shown; ++i) {
    const TrialSummary::MarkSummary& each = summary.marks[i];
    text += fmt::format("  {:<20} {}  ({})\n", TimesText(each.mark), PrintableLine(each.mark.text),
                        LoadsText(each.loads));
  }
  if (shown < summary.marks.size()) {
    text += fmt::format("  and {} more, in --json\n", summary.marks.size() - shown);
  }
  if (!summary.notes.empty()) text += '\n';
  for (const std::string& note : summary.notes) text += note + '\n';
  return text;
}

json SummaryJson(const TrialSummary& summary) {
  json facts = json::array(), exposure = json::array(), marks = json::array();
  for (const TrialSummary::MarkSummary& each : summary.marks) marks.push_back(MarkJson(each));
  for (const Fact& fact : summary.facts) {
    facts.push_back({{"name", fact.label}, {"value", fact.value}, {"is_assumed", fact.is_assumed}});
  }
  for (std::size_t i = 0; i < summary.joints.size(); ++i) {
    exposure.push_back(JointJson(ScoredName(i), summary.joints[i], summary.limits));
  }
  return {{"person", summary.character},
          {"name", summary.name},
          {"samples", summary.samples},
          {"seconds", summary.secs},
          {"mass_kg", summary.mass_kg},
          {"mass_with_extra_kg", summary.mass_with_added_kg},
          {"height_m", summary.height_m},
          {"facts", facts},
          {"notes", summary.notes},
          {"exposure", exposure},
          {"com_minus_mvn_m", ValueJson(summary.com_minus_mvn_m)},
          {"l5_s1_compression_N", CompressionJson(summary)},
          {"l5_s1_shear_N", ValueJson(summary.shear)},
          {"marks", marks}};
}

}  // namespace kinescope::app
