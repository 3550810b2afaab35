/// What a person has decided about the pictures of a run and not carried out: `review.json` in the
/// folder of the run, so that a review can be continued later. It may come from a stranger, like
/// the run, and so can put nothing into the accepted pictures: whether a picture is accepted is
/// seen in `golden.lock` alone. Pure but for files; one thread.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

enum class Decision {
  kUndecided,
  kAccepted,  // never in `review.json`
  kRejected,
  kLater,
};

/// "undecided", "accepted", "rejected", "later".
const char* Name(Decision decision);

/// A decision, and what it was about.
struct KeptDecision {
  Decision decision = Decision::kLater;
  std::string pixels;           // SHA-256 of the picture that was drawn
  std::string accepted_pixels;  // of the one that it was compared with; "": none
};

/// By the names of the cases.
using KeptDecisions = std::map<std::string, KeptDecision>;

/// Of the same two pictures, so that a decision outlives another check that draws the same, and no
/// other. kUndecided: there is none.
Decision DecisionFor(const CaseVerdict& verdict, const KeptDecisions& kept);
/// @pre it was drawn
void Keep(Decision decision, const CaseVerdict& verdict, KeptDecisions& kept);

/// The content of `review.json`. @throws std::exception with the reason.
KeptDecisions ParseDecisions(const std::string& text);
/// Empty if there is no such file. @throws UsageError with file, reason and remedy.
KeptDecisions ReadDecisions(const std::filesystem::path& run);
/// @throws std::runtime_error with file and reason.
void WriteDecisions(const std::filesystem::path& run, const KeptDecisions& kept);

}  // namespace kinescope::app
