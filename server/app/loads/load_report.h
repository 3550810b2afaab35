/// Writes the report of a trial: one A4 page per person, self-contained HTML (embedded pictures, no
/// scripts, no external files). One thread.
#pragma once

#include <filesystem>
#include <map>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/picture/backend.h"

namespace kinescope::app {

/// Contains person, exposure of every joint, pictures of the times with the highest loads, all
/// ratios over time, assumptions and unknown loads. @pre trials keep their curves
/// @throws std::runtime_error with the path and the reason; RenderError.
void WriteReport(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                 const BackendOptions& backend, const std::filesystem::path& path);

}  // namespace kinescope::app
