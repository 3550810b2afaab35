/// Writes H.264 in MP4 and VP9 in WebM with libav. One thread per writer.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, for kMp4 and kWebm; the arguments are already checked.
std::unique_ptr<VideoWriter> MakeCodecWriter(const std::filesystem::path& path, ClipFormat format,
                                             int width, int height, const VideoOptions& options);

}  // namespace kinescope::render::av
