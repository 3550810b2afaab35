/// Animated WebP with libwebp: what libav has of it knows neither metadata nor how to read it.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, of kWebp; the arguments have been checked. Packed pictures stay in memory
/// until Finish. Metadata are an XMP packet, whose dc:title and dc:description are "title" and
/// "comment".
std::unique_ptr<VideoWriter> MakeWebpWriter(const std::filesystem::path& path, int width,
                                            int height, const VideoOptions& options);

/// As OpenVideo.
std::unique_ptr<VideoReader> OpenWebp(const std::filesystem::path& path);

}  // namespace kinescope::render::av
