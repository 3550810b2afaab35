/// Writes and reads animated WebP with libwebp, because libav can neither read it nor write its
/// metadata. One thread per writer or reader.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As MakeVideoWriter, for kWebp; the arguments are already checked. Encoded frames stay in memory
/// until Finish. Metadata are written as an XMP packet; its dc:title and dc:description are "title"
/// and "comment".
std::unique_ptr<VideoWriter> MakeWebpWriter(const std::filesystem::path& path, int width,
                                            int height, const VideoOptions& options);

/// As OpenVideo.
std::unique_ptr<VideoReader> OpenWebp(const std::filesystem::path& path);

}  // namespace kinescope::render::av
