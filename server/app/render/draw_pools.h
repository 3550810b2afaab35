/// Keeps the pool that draws from one run to the next, because its renderers take longer to make
/// than a small picture to draw. One thread.
#pragma once

#include <memory>
#include <string>

#include "render/renderer.h"
#include "server/app/render/draw_pool.h"
#include "server/picture/backend.h"

namespace kinescope::app {

class DrawPools {
 public:
  /// A pool of `jobs` threads for pictures of that size: the one of the last call where that has as
  /// many threads and the same back-end. @pre nothing of it is used any more. @throws RenderError,
  /// UsageError.
  DrawPool& PoolFor(int jobs, const render::PictureSpec& spec, const BackendOptions& backend);

 private:
  std::string made_for_;
  std::unique_ptr<DrawPool> pool_;
};

}  // namespace kinescope::app
