#include "render/video.h"

#include <algorithm>

#include "core/picture_limits.h"
#include "core/system/errors.h"
#include "render/module.h"

namespace kinescope::render {
namespace {

void CheckSize(ClipFormat format, int width, int height) {
  // 4:2:0 stores colour for every second pixel of every second row.
  const bool is_even = format == ClipFormat::kMp4 || format == ClipFormat::kWebm;
  const auto fits = [&](int side) {
    return side >= kMinPictureSide && side <= kMaxPictureSide && (!is_even || side % 2 == 0);
  };
  if (fits(width) && fits(height)) return;
  throw UsageError("clip size " + std::to_string(width) + " x " + std::to_string(height) +
                   ": expected " + std::string(is_even ? "even sides of " : "sides of ") +
                   "16 to 8192 px");
}

void CheckRate(ClipFormat format, FrameRate rate) {
  const double most = format == ClipFormat::kGif ? 50 : 1000;
  if (rate.numerator > 0 && rate.denominator > 0 && rate.hz() <= most) return;
  throw UsageError("--fps=" + std::to_string(rate.numerator) + "/" +
                   std::to_string(rate.denominator) + ": expected more than 0, at most " +
                   std::to_string(static_cast<int>(most)) + " frames per second" +
                   (format == ClipFormat::kGif ? " in a GIF" : ""));
}

void CheckQuality(ClipFormat format, const VideoOptions& options) {
  const int most_crf = format == ClipFormat::kWebm ? 63 : 51;
  if (options.crf && (*options.crf < 0 || *options.crf > most_crf)) {
    throw UsageError("--crf=" + std::to_string(*options.crf) + ": expected 0 to " +
                     std::to_string(most_crf));
  }
  if (options.quality < 0 || options.quality > 100) {
    throw UsageError("--quality=" + std::to_string(options.quality) + ": expected 0 to 100");
  }
}

const VideoModule& OpenVideoModule() {
  return OpenModule<VideoModule>("libkinescope_video.so", kVideoEntry);
}

}  // namespace

std::unique_ptr<VideoWriter> MakeVideoWriter(const std::filesystem::path& path, int width,
                                             int height, const VideoOptions& options) {
  const auto format = ClipFormatOf(path);
  if (!format) {
    throw UsageError(path.string() + ": expected a name that ends in .mp4, .webm, .webp or .gif");
  }
  CheckSize(*format, width, height);
  CheckRate(*format, options.rate);
  CheckQuality(*format, options);
  return OpenVideoModule().make(path, *format, width, height, options);
}

std::unique_ptr<VideoReader> OpenVideo(const std::filesystem::path& path) {
  return OpenVideoModule().open(path);
}

}  // namespace kinescope::render
