#include "server/app/view_options.h"

#include <fmt/format.h>

#include "server/app/pipeline_options.h"
#include "server/core/errors.h"

namespace kinescope::app {

render::View ToView(const ViewOptions& options) {
  const auto [width, height] = ToSize("size", options.size);
  if (options.supersample != 1 && options.supersample != 2 && options.supersample != 4) {
    throw UsageError(fmt::format("--supersample={}: expected 1, 2 or 4", options.supersample));
  }
  return {width, height, options.supersample, options.title, !options.no_overlays};
}

}  // namespace kinescope::app
