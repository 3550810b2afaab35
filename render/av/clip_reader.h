/// Reads clips with libav. One thread per reader.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As OpenVideo, for all formats except animated WebP.
std::unique_ptr<VideoReader> OpenClip(const std::filesystem::path& path);

}  // namespace kinescope::render::av
