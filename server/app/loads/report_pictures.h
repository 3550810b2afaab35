/// Renders the worst postures of a trial for the report. One thread.
#pragma once

#include <vector>

#include "render/renderer.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/report_page.h"

namespace kinescope::app {

/// At most three: the highest compression at L5/S1, then the joints with the highest ratios
/// (LoadTrial::WorstPostures). Colours are of the ratio in the caption.
/// Empty: no load is known.
/// @throws RenderError; std::runtime_error after Ctrl-C.
std::vector<ReportPicture> DrawWorstPostures(const LoadTrial& trial, render::Renderer& renderer);

}  // namespace kinescope::app
