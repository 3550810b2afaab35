/// The verdicts of `golden check` as JUnit XML, which CI servers show beside each case. A case that
/// differs is a failure, one that was not compared an error; each names the pictures that are
/// written ([[ATTACHMENT|path]], which GitLab and Jenkins show). Pure function; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_check.h"

namespace kinescope::app {

/// `out`: CheckSettings::out. `folder`: of the cases.
std::string ToJunit(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& folder,
                    const std::filesystem::path& out);

}  // namespace kinescope::app
