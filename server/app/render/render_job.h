/// One source to all of its outputs, in one pass: scenes are read and shots planned here, in order;
/// they are drawn by a DrawPool and written by each output's own threads, while this one goes on.
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
  long drawn = 0;             // of these, now; the others were there already
  double secs = 0;            // how long it shows them; of a clip or sequence
  double took_secs = 0;       // to draw and write them
  std::uint32_t counter = 0;  // of the sample that a still shows
};

/// How a job is run: nothing of it changes a pixel.
struct JobSettings {
  int jobs = 1;
  bool force = false;                // also what is there already
  bool sidecar = true;               // writes FILE.json
  std::optional<long> only_picture;  // of clips and sequences: no other
};

/// @throws UsageError, SourceError, RenderError, std::runtime_error; then no output that is not
/// whole is under its name. Of a sequence, the pictures that are finished stay.
std::vector<OutputResult> RenderSource(const RenderOptions& options, const SourcePlan& plan,
                                       const JobSettings& settings, DrawPool& pool);

/// A pool for pictures of that size. @throws RenderError, UsageError.
std::unique_ptr<DrawPool> MakeDrawPool(int jobs, const render::View& view,
                                       const BackendOptions& backend);

}  // namespace kinescope::app
