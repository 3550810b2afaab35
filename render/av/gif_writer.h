/// Animated GIF with libav: one palette of 256 colours for the whole clip, chosen from all of its
/// pictures. These wait, packed without loss, in a file without a name beside the clip.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, of kGif; the arguments have been checked.
std::unique_ptr<VideoWriter> MakeGifWriter(const std::filesystem::path& path, int width, int height,
                                           const VideoOptions& options);

}  // namespace kinescope::render::av
