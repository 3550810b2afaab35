#include "server/app/loads/report_finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/compression_limits.h"
#include "core/system/words.h"
#include "server/app/loads/report_text.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

std::uint64_t SamplesAbove(const loads::JointExposure& exposure, std::size_t limit) {
  const std::uint64_t high = exposure.samples[static_cast<std::size_t>(LoadClass::kHigh)];
  if (limit == 1) return high;
  return high + exposure.samples[static_cast<std::size_t>(LoadClass::kMedium)];
}

// With the most samples above the class limit, of several the one with the highest peak; nullopt:
// none is ever above it.
std::optional<std::size_t> WorstJoint(const LoadTrial& trial, std::size_t limit) {
  std::optional<std::size_t> worst;
  std::pair<std::uint64_t, double> most;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const loads::JointExposure exposure = trial.exposure().Of(i);
    const std::pair of(SamplesAbove(exposure, limit), exposure.peak_ratio);
    if (of.first == 0 || (worst && of <= most)) continue;
    worst = i;
    most = of;
  }
  return worst;
}

std::string Capitalised(std::string text) {
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string AboveSentence(const LoadTrial& trial, const TrialContext& context, std::size_t joint,
                          std::size_t limit) {
  const loads::JointExposure exposure = trial.exposure().Of(joint);
  const std::uint64_t above = SamplesAbove(exposure, limit), all = trial.samples();
  const double longest_secs = exposure.above[limit].longest_secs;
  return fmt::format(
      "{} was above a ratio of {:.2f} for {} % of the trial ({} of {}){}.", JointWord(joint),
      context.scene.loads.meter.up[limit], PercentText(above, all), above, Counted(all, "sample"),
      longest_secs > 0 ? fmt::format(", at most {:.2f} s at a time", longest_secs) : "");
}

// No joint is ever above the lower limit.
std::string HighestSentence(const LoadTrial& trial, const TrialContext& context) {
  std::size_t highest = 0;
  double ratio = -1;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const double of = trial.exposure().Of(i).peak_ratio;
    if (!std::isfinite(of) || of <= ratio) continue;
    highest = i;
    ratio = of;
  }
  return fmt::format(
      "No known load was above a ratio of {:.2f}; the highest was {:.2f}, {} at {:.2f} s.",
      context.scene.loads.meter.up[0], ratio, JointWord(highest),
      trial.SecsOf(trial.exposure().Of(highest).peak_stamp_nanos));
}

std::string UnknownSentence(const LoadTrial& trial) {
  std::vector<std::size_t> joints;
  std::uint64_t most = 0, least = trial.samples();
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const std::uint64_t unknown =
        trial.exposure().Of(i).samples[static_cast<std::size_t>(LoadClass::kUnknown)];
    if (unknown == 0) continue;
    joints.push_back(i);
    most = std::max(most, unknown);
    least = std::min(least, unknown);
  }
  if (joints.empty()) return "";
  const std::string share = most == trial.samples()
                                ? std::string("the whole trial")
                                : PercentText(most, trial.samples()) + " % of the trial";
  return fmt::format("Unknown for {}{}: {}.", least < most ? "up to " : "", share,
                     joints.size() == urdf::kScoredJointCount ? "all joints" : JointWords(joints));
}

}  // namespace

std::string CompressionSentence(double peak_newtons) {
  const auto [action, upper] = kCompressionLimits;
  constexpr double kPercent = 100 * kCompressionUncertainty;
  const double low = (1 - kCompressionUncertainty) * peak_newtons;
  const double high = (1 + kCompressionUncertainty) * peak_newtons;
  const auto verdict = [&](double limit) {
    if (low > limit) return fmt::format("above {:g} N even at −{:g} %", limit, kPercent);
    if (high <= limit) return fmt::format("below {:g} N even at +{:g} %", limit, kPercent);
    return fmt::format("{} {:g} N, but not beyond doubt",
                       peak_newtons > limit ? "above" : "not above", limit);
  };
  std::string text =
      fmt::format("Peak compression at L5/S1 was {:.0f} N (±{:g} % is {:.0f} to {:.0f} N): {}",
                  peak_newtons, kPercent, low, high, verdict(action));
  if (high > upper) {
    text += "; " + verdict(upper);
  } else if (high > action) {
    text += fmt::format("; {:g} N was not reached", upper);
  }
  return text + ".";
}

Finding FindingOf(const LoadTrial& trial, const TrialContext& context) {
  Finding finding;
  if (!trial.knows_anything()) {
    finding.headline = "No load could be computed at any time.";
    std::string reasons;
    for (std::size_t i = 0; i < urdf::kScoredJointCount && reasons.empty(); ++i) {
      for (const auto& [why, secs] : trial.why_unknown(i)) {
        reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", why);
      }
    }
    if (!reasons.empty()) finding.details = "Reason: " + reasons + ".";
    return finding;
  }
  const std::optional<std::size_t> high = WorstJoint(trial, 1), medium = WorstJoint(trial, 0);
  finding.is_high = high.has_value();
  if (high) {
    finding.headline = Capitalised(AboveSentence(trial, context, *high, 1));
  } else if (medium) {
    finding.headline =
        fmt::format("No known load was above a ratio of {:.2f}; {}",
                    context.scene.loads.meter.up[1], AboveSentence(trial, context, *medium, 0));
  } else {
    finding.headline = HighestSentence(trial, context);
  }
  const auto add = [&](const std::string& sentence) {
    if (!sentence.empty()) finding.details += (finding.details.empty() ? "" : " ") + sentence;
  };
  if (trial.compression().count > 0) add(CompressionSentence(trial.compression().most));
  std::vector<std::size_t> above_one;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    if (trial.exposure().Of(i).peak_ratio > 1) above_one.push_back(i);
  }
  if (!above_one.empty()) add("Above a ratio of 1 (‡): " + JointWords(above_one) + ".");
  add(UnknownSentence(trial));
  return finding;
}

}  // namespace kinescope::app
