/// The check of one picture of a golden case: what it shows, what its pixels are, and what both say
/// against what is accepted. One thread.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/app/golden/golden_check.h"

namespace kinescope::app {

/// A verdict of this picture that says nothing yet.
CaseVerdict VerdictOf(const GoldenSuite& suite, const FoundCase& found,
                      const std::optional<GoldenFrame>& frame);

/// Of a key in the file of the case; 1 if the file does not set it.
int LineOf(const FoundCase& found, const std::string& key);

/// @throws UsageError if the masks do not fit this picture, or hide too much of it.
void CheckMasksOf(const FoundCase& found, const GoldenDrawing& drawing);

/// Writes the pictures of one that is not the same into the folder of the run.
/// @pre CheckMasksOf() has not thrown
/// @throws std::runtime_error if a picture cannot be written.
CaseVerdict CheckPicture(const GoldenSuite& suite, const FoundCase& found,
                         const CheckSettings& settings,
                         const std::map<std::string, std::string>& environment,
                         GoldenDrawing drawing);

}  // namespace kinescope::app
