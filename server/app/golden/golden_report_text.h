/// What the report of a check says of a verdict: texts, some of them as HTML, and the order of the
/// cases. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// "low (green)" as HTML, with a dot of this colour before it.
std::string WithDots(const std::string& text);

/// The worst of it, in one clause.
std::string FirstLine(const CaseVerdict& verdict);

/// The worst first, then those of which nothing is known, then the others; by name among equals.
std::vector<const CaseVerdict*> InOrder(const std::vector<CaseVerdict>& verdicts);

/// Those of layers stand in their table.
std::vector<GoldenFinding> WithoutLayers(const std::vector<GoldenFinding>& findings);

}  // namespace kinescope::app
