/// Renders one source to all of its outputs in one pass. The calling thread reads scenes and plans
/// requests, in order; a DrawPool renders them, and the threads of each output write them at the
/// same time.
#pragma once

#include <vector>

#include "server/app/render/draw_pool.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/output_writer.h"
#include "server/app/render/render_options.h"
#include "server/app/render/run_settings.h"

namespace kinescope::app {

/// @throws UsageError, SourceError, RenderError, std::runtime_error; then no incomplete file has
/// the name of an output. Finished pictures of a sequence stay.
std::vector<OutputResult> RenderSource(const RenderOptions& options, const SourcePlan& plan,
                                       const RunSettings& settings, DrawPool& pool);

}  // namespace kinescope::app
