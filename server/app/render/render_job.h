/// Renders one source to all of its outputs in one pass. The calling thread reads scenes and plans
/// shots, in order; a DrawPool renders them, and the threads of each output write them at the same
/// time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/app/render/draw_pool.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/render_options.h"

namespace kinescope::app {

struct OutputResult {
  std::string out;
  OutputKind kind = OutputKind::kStill;
  long pictures = 0;          // of the output
  long drawn = 0;             // of these, rendered in this run; the others were up to date
  double secs = 0;            // duration of the clip or sequence, s
  double took_secs = 0;       // time to render and write them, s
  std::uint32_t counter = 0;  // sample counter of a still
};

/// How a job is run; nothing here changes a pixel.
struct JobSettings {
  int jobs = 1;
  bool force = false;                // also renders outputs that are up to date
  bool sidecar = true;               // write FILE.json
  std::optional<long> only_picture;  // of clips and sequences: only this picture
};

/// @throws UsageError, SourceError, RenderError, std::runtime_error; then no incomplete file has
/// the name of an output. Finished pictures of a sequence stay.
std::vector<OutputResult> RenderSource(const RenderOptions& options, const SourcePlan& plan,
                                       const JobSettings& settings, DrawPool& pool);

/// A pool for pictures of that size. @throws RenderError, UsageError.
std::unique_ptr<DrawPool> MakeDrawPool(int jobs, const render::View& view,
                                       const BackendOptions& backend);

}  // namespace kinescope::app
