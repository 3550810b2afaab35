/// The report of a check: one HTML file that needs no network, no server and, for pictures and
/// words, no scripts. Pure but for reading the pictures; one thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

struct ReportSettings {
  std::filesystem::path folder;  // of the cases and their accepted pictures
  std::filesystem::path out;     // of the run
};

/// A picture that cannot be read is left out: its verdict says why.
std::string GoldenReport(const std::vector<CaseVerdict>& verdicts, const ReportSettings& settings);

}  // namespace kinescope::app
