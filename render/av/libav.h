/// Common parts of all uses of libav: owners of its structs, and its errors as exceptions.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <filesystem>
#include <memory>

#include "render/image/image.h"

namespace kinescope::render::av {

template <class T, void (*kFree)(T**)>
struct FreeByAddress {
  void operator()(T* pointer) const { kFree(&pointer); }
};
using CodecContext =
    std::unique_ptr<AVCodecContext, FreeByAddress<AVCodecContext, avcodec_free_context>>;
using FilterGraph =
    std::unique_ptr<AVFilterGraph, FreeByAddress<AVFilterGraph, avfilter_graph_free>>;
using Frame = std::unique_ptr<AVFrame, FreeByAddress<AVFrame, av_frame_free>>;
using InputFormat =
    std::unique_ptr<AVFormatContext, FreeByAddress<AVFormatContext, avformat_close_input>>;
using Packet = std::unique_ptr<AVPacket, FreeByAddress<AVPacket, av_packet_free>>;

struct CloseOutput {
  void operator()(AVFormatContext* format) const;
};
using OutputFormat = std::unique_ptr<AVFormatContext, CloseOutput>;

struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
using Scaler = std::unique_ptr<SwsContext, FreeScaler>;

/// Throws std::runtime_error "cannot `what` `path`: reason" for a `result` below 0.
void Check(int result, const char* what, const std::filesystem::path& path);

/// @throws std::runtime_error with `path`, the encoder and the Debian package that contains it.
const AVCodec& FindEncoder(const char* name, const char* package,
                           const std::filesystem::path& path);

/// A libav frame with its own memory.
Frame MakeFrame(AVPixelFormat format, int width, int height, const std::filesystem::path& path);

/// @throws std::runtime_error if `image` is not `width` x `height`.
void CheckSameSize(const Image& image, int width, int height, const std::filesystem::path& path);

}  // namespace kinescope::render::av
