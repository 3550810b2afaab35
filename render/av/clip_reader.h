/// Clips read with libav.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video.h"

namespace kinescope::render::av {

/// As OpenVideo, of what is no animated WebP.
std::unique_ptr<VideoReader> OpenClip(const std::filesystem::path& path);

}  // namespace kinescope::render::av
