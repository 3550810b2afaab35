#include "render/video.h"

#include <cmath>

#include "render/module.h"
#include "server/core/errors.h"

namespace kinescope::render {

std::unique_ptr<VideoWriter> MakeVideoWriter(const std::filesystem::path& path, int width,
                                             int height, const VideoOptions& options) {
  // 4:2:0 stores colour for every second pixel of every second row.
  if (width < 16 || height < 16 || width > 8192 || height > 8192 || width % 2 != 0 ||
      height % 2 != 0) {
    throw UsageError("a clip's width and height are even and 16 to 8192 px, not " +
                     std::to_string(width) + " x " + std::to_string(height));
  }
  if (!(options.frames_per_second > 0 && options.frames_per_second <= 1000)) {
    throw UsageError("a clip has more than 0 and at most 1000 pictures a second, not " +
                     std::to_string(options.frames_per_second));
  }
  if (options.crf < 0 || options.crf > 51) {
    throw UsageError("crf is 0 to 51, not " + std::to_string(options.crf));
  }
  const auto* module =
      static_cast<const VideoModule*>(LoadModule("libkinescope_video.so", kVideoEntry));
  return module->make(path, width, height, options);
}

}  // namespace kinescope::render
