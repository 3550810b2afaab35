#include "render/av/libav.h"

extern "C" {
#include <libavutil/error.h>
}

#include <array>
#include <stdexcept>
#include <string>

namespace kinescope::render::av {

void CloseOutput::operator()(AVFormatContext* format) const {
  if (format->pb != nullptr) avio_closep(&format->pb);
  avformat_free_context(format);
}

void Check(int result, const char* what, const std::filesystem::path& path) {
  if (result >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(result, text.data(), text.size());
  throw std::runtime_error(std::string("cannot ") + what + " " + path.string() + ": " +
                           text.data());
}

const AVCodec& FindEncoder(const char* name, const char* package,
                           const std::filesystem::path& path) {
  if (const AVCodec* encoder = avcodec_find_encoder_by_name(name)) return *encoder;
  throw std::runtime_error("cannot encode " + path.string() +
                           ": this libavcodec does not contain " + name + "; install Debian's " +
                           package);
}

Frame MakeFrame(AVPixelFormat format, int width, int height, const std::filesystem::path& path) {
  Frame frame(av_frame_alloc());
  if (!frame) Check(AVERROR(ENOMEM), "allocate pictures of", path);
  frame->format = format;
  frame->width = width;
  frame->height = height;
  Check(av_frame_get_buffer(frame.get(), 0), "allocate pictures of", path);
  return frame;
}

void CheckSameSize(const Image& image, int width, int height, const std::filesystem::path& path) {
  if (image.width == width && image.height == height) return;
  const auto size = [](int w, int h) { return std::to_string(w) + " x " + std::to_string(h); };
  throw std::runtime_error(path.string() +
                           ": all frames of a clip need the size of the first one, " +
                           size(width, height) + ", not " + size(image.width, image.height));
}

}  // namespace kinescope::render::av
