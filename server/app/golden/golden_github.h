/// The verdicts as GitHub shows them: a summary in Markdown, and annotations at the lines of the
/// cases. Pure functions; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// For the page of a job, or a comment. At most 900 kB, of the 1 MiB that GitHub takes. `out`: of
/// the run.
std::string ToMarkdown(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& out);

/// Workflow commands for standard output, one per line; 10 at most, as GitHub shows no more: if
/// there are more cases, the first says so.
std::string ToAnnotations(const std::vector<CaseVerdict>& verdicts,
                          const std::filesystem::path& out);

}  // namespace kinescope::app
