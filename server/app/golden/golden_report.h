/// The report of a check: one HTML file that needs no network, no server and, for pictures and
/// words, no scripts. `golden review` serves the same page, which then carries out what is decided.
/// Verdicts may come from a stranger: all of their texts are escaped. Pure but for reading the
/// pictures; one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// What the page has besides when ReviewSite serves it.
struct ReviewedPage {
  std::string token;  // for its requests
  std::string nonce;  // of its style and script, for the Content-Security-Policy of the answer
};

struct ReportSettings {
  std::filesystem::path folder;                       // of the cases
  std::filesystem::path pictures;                     // folder of the accepted pictures
  std::filesystem::path out;                          // of the run
  std::string version = KINESCOPE_VERSION;            // of the program that has drawn
  std::optional<ReviewedPage> review = std::nullopt;  // nullopt: a file
};

/// A picture that cannot be read, or has more than 64 MiB, is left out. @pre the names of those
/// that were drawn are names of files
std::string GoldenReport(const std::vector<CaseVerdict>& verdicts, const ReportSettings& settings);

}  // namespace kinescope::app
