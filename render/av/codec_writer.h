/// H.264 in MP4 and VP9 in WebM with libav.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, of kMp4 and kWebm; the arguments have been checked.
std::unique_ptr<VideoWriter> MakeCodecWriter(const std::filesystem::path& path, ClipFormat format,
                                             int width, int height, const VideoOptions& options);

}  // namespace kinescope::render::av
