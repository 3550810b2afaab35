/// The answer of a trial in a few sentences: the worst joint with its limit, share, samples and
/// longest time; the peak compression with its uncertainty; ratios above 1; what is unknown. Pure
/// functions; any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"

namespace kinescope::app {

/// Plain text.
struct Finding {
  std::string headline;  // one sentence
  std::string details;   // the others; "": none
  bool is_high = false;  // a load is above the upper class limit
};

Finding FindingOf(const LoadTrial& trial, const TrialContext& context);

/// "Peak compression at L5/S1 was 3825 N: above 3400 N, but not beyond doubt ...".
std::string CompressionSentence(double peak_newtons);

/// Uncertainty of the compression force at L5/S1: this share of it, both ways (docs/loads.md).
inline constexpr double kCompressionUncertainty = 0.25;

}  // namespace kinescope::app
