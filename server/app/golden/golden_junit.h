/// The verdicts of `golden check` as JUnit XML, which CI servers show beside each case. A case that
/// differs is a failure, one that was not compared an error; each names the picture that explains
/// it
/// ([[ATTACHMENT|path]], which GitLab and Jenkins show). Reads the environment; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// `out`: CheckSettings::out. `folder`: of the cases.
std::string ToJunit(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& folder,
                    const std::filesystem::path& out);

}  // namespace kinescope::app
