#include "render/module.h"

#include "render/av/clip_reader.h"
#include "render/av/codec_writer.h"
#include "render/av/gif_writer.h"
#include "render/av/libav.h"
#include "render/av/webp_clip.h"

namespace kinescope::render::av {
namespace {

std::unique_ptr<VideoWriter> Make(const std::filesystem::path& path, ClipFormat format, int width,
                                  int height, const VideoOptions& options) {
  av_log_set_level(AV_LOG_ERROR);  // x264 is fond of telling how well it did
  switch (format) {
    case ClipFormat::kMp4:
    case ClipFormat::kWebm: return MakeCodecWriter(path, format, width, height, options);
    case ClipFormat::kWebp: return MakeWebpWriter(path, width, height, options);
    case ClipFormat::kGif: return MakeGifWriter(path, width, height, options);
  }
  return nullptr;
}

std::unique_ptr<VideoReader> Open(const std::filesystem::path& path) {
  av_log_set_level(AV_LOG_FATAL);  // what is wrong with a file is thrown
  // libav 59 reads still WebP only.
  return ClipFormatOf(path) == ClipFormat::kWebp ? OpenWebp(path) : OpenClip(path);
}

}  // namespace
}  // namespace kinescope::render::av

extern "C" __attribute__((visibility("default"))) const void* KinescopeVideoModule() {
  static const kinescope::render::VideoModule module = {
      {}, &kinescope::render::av::Make, &kinescope::render::av::Open};
  return &module;
}
