// What both the program and the module of encoders know about clips.
#include "render/video.h"

namespace kinescope::render {

std::int64_t FrameRate::NanosOf(std::int64_t k) const {
  // A day at 1000 pictures a second is 8.64e7 pictures: no overflow with denominators up to 1001.
  const std::int64_t whole = k / numerator, rest = k % numerator;
  const std::int64_t scaled = rest * denominator * 1'000'000'000;
  return whole * denominator * 1'000'000'000 + (scaled + numerator / 2) / numerator;
}

std::optional<ClipFormat> ClipFormatOf(const std::filesystem::path& path) {
  const std::string extension = path.extension();
  if (extension == ".mp4") return ClipFormat::kMp4;
  if (extension == ".webm") return ClipFormat::kWebm;
  if (extension == ".webp") return ClipFormat::kWebp;
  if (extension == ".gif") return ClipFormat::kGif;
  return std::nullopt;
}

}  // namespace kinescope::render
