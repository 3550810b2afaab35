/// Writes animated GIF with libav: one palette of 256 colours for the whole clip, computed from all
/// of its frames. Until then the frames are stored without loss in an unnamed file in the folder of
/// the clip. One thread per writer.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, for kGif; the arguments are already checked.
std::unique_ptr<VideoWriter> MakeGifWriter(const std::filesystem::path& path, int width, int height,
                                           const VideoOptions& options);

}  // namespace kinescope::render::av
