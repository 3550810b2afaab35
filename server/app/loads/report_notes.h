/// What the report says beside its numbers: facts about the person, the method in use, and what
/// limits the trust in the results. Plain text, pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"

namespace kinescope::app {

/// For the head of the page, with all that is assumed.
std::vector<Fact> HeadFactsOf(const LoadTrial& trial, const TrialContext& context);

/// One paragraph.
std::string MethodText(const LoadTrial& trial, const TrialContext& context);

/// Most important first: what was changed meanwhile, unknown loads, deviations from the options,
/// checks, limits of the method.
std::vector<std::string> TrustNotesOf(const LoadTrial& trial, const TrialContext& context);

}  // namespace kinescope::app
