/// The report of a trial: one page of A4 for each person, self-contained HTML (pictures inside, no
/// script, nothing from elsewhere).
#pragma once

#include <filesystem>
#include <map>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/picture/backend.h"

namespace kinescope::app {

/// Who, exposure of every joint, the worst moments as pictures, all ratios over time, what was
/// assumed or could not be known. @pre trials keep their curves
/// @throws std::runtime_error naming the path and the reason; RenderError.
void WriteReport(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                 const BackendOptions& backend, const std::filesystem::path& path);

}  // namespace kinescope::app
