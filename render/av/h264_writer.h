/// H.264 in MP4 with libav. The only place that knows libav.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter; the arguments have been checked. @throws std::runtime_error.
std::unique_ptr<VideoWriter> MakeH264Writer(const std::filesystem::path& path, int width,
                                            int height, const VideoOptions& options);

}  // namespace kinescope::render::av
