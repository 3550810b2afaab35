#include "render/av/h264_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/error.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "render/new_file.h"

namespace kinescope::render::av {
namespace {

// A fixed number, so that a clip does not depend on the machine: x264 decides a little differently
// for every count of frame threads.
constexpr int kEncoderThreads = 4;

template <class T, void (*kFree)(T**)>
struct FreeByAddress {
  void operator()(T* pointer) const { kFree(&pointer); }
};
using CodecContext =
    std::unique_ptr<AVCodecContext, FreeByAddress<AVCodecContext, avcodec_free_context>>;
using Frame = std::unique_ptr<AVFrame, FreeByAddress<AVFrame, av_frame_free>>;
using Packet = std::unique_ptr<AVPacket, FreeByAddress<AVPacket, av_packet_free>>;

struct CloseFormat {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

// 29.97 and its kind mean 30000/1001; anything else is the nearest simple fraction.
AVRational ExactRate(double frames_per_second) {
  const double rounded = std::round(frames_per_second);
  const bool is_ntsc = rounded > 0 && std::fmod(rounded, 6) == 0 &&
                       std::abs(frames_per_second - rounded * 1000 / 1001) < 0.005;
  if (is_ntsc) return {static_cast<int>(rounded) * 1000, 1001};
  return av_d2q(frames_per_second, 100000);
}

class H264Writer : public VideoWriter {
 public:
  H264Writer(const std::filesystem::path& path, int width, int height, const VideoOptions& options)
      : path_(path), file_(path), packet_(av_packet_alloc()) {
    OpenEncoder(width, height, options);
    OpenContainer(options);
    MakeFrame();
  }

  void Add(const Image& image) override {
    if (image.width != frame_->width || image.height != frame_->height) {
      throw std::runtime_error(
          path_.string() + ": every picture of a clip has its first one's size, " +
          Size(frame_->width, frame_->height) + ", not " + Size(image.width, image.height));
    }
    Check(av_frame_make_writable(frame_.get()), "allocate");
    const std::uint8_t* rows[] = {image.rgba.data()};
    const int strides[] = {4 * image.width};
    sws_scale(scaler_.get(), rows, strides, 0, image.height, frame_->data, frame_->linesize);
    frame_->pts = next_++;
    Encode(frame_.get());
  }

  void Finish() override {
    if (next_ == 0)
      throw std::runtime_error(path_.string() + ": a clip needs at least one picture");
    Encode(nullptr);
    Check(av_write_trailer(format_.get()), "finish");
    avio_flush(format_->pb);
    Check(format_->pb->error, "write");
    Check(avio_closep(&format_->pb), "close");
    file_.Commit();
  }

 private:
  static std::string Size(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
  }

  void Check(int result, const char* what) const {
    if (result >= 0) return;
    std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
    av_strerror(result, text.data(), text.size());
    throw std::runtime_error(std::string("cannot ") + what + " " + path_.string() + ": " +
                             text.data());
  }

  void OpenEncoder(int width, int height, const VideoOptions& options) {
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (encoder == nullptr) {
      throw std::runtime_error("cannot encode " + path_.string() +
                               ": this libavcodec has no libx264; install Debian's libavcodec59");
    }
    codec_.reset(avcodec_alloc_context3(encoder));
    const AVRational rate = ExactRate(options.frames_per_second);
    codec_->width = width;
    codec_->height = height;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->framerate = rate;
    codec_->time_base = av_inv_q(rate);
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->gop_size = std::max(1, static_cast<int>(std::lround(2 * options.frames_per_second)));
    codec_->thread_count = kEncoderThreads;
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    Check(av_opt_set(codec_->priv_data, "preset", "veryfast", 0), "configure");
    Check(av_opt_set_double(codec_->priv_data, "crf", options.crf, 0), "configure");
    Check(avcodec_open2(codec_.get(), encoder, nullptr), "encode");
  }

  void OpenContainer(const VideoOptions& options) {
    const std::string url = file_.open_path();
    AVFormatContext* format = nullptr;
    Check(avformat_alloc_output_context2(&format, nullptr, "mp4", url.c_str()), "write");
    format_.reset(format);
    format_->flags |= AVFMT_FLAG_BITEXACT;  // no version strings: the same clip is the same bytes
    stream_ = avformat_new_stream(format_.get(), nullptr);
    if (stream_ == nullptr) Check(AVERROR(ENOMEM), "write");
    Check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "write");
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = stream_->r_frame_rate = codec_->framerate;
    for (const auto& [key, value] : options.metadata) {
      Check(av_dict_set(&format_->metadata, key.c_str(), value.c_str(), 0), "tag");
    }
    Check(avio_open(&format_->pb, url.c_str(), AVIO_FLAG_WRITE), "write");
    AVDictionary* muxer = nullptr;
    av_dict_set(&muxer, "movflags", "+faststart", 0);
    const int result = avformat_write_header(format_.get(), &muxer);
    av_dict_free(&muxer);
    Check(result, "write");
  }

  void MakeFrame() {
    frame_.reset(av_frame_alloc());
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    Check(av_frame_get_buffer(frame_.get(), 0), "allocate");
    scaler_.reset(sws_getContext(frame_->width, frame_->height, AV_PIX_FMT_RGBA, frame_->width,
                                 frame_->height, codec_->pix_fmt,
                                 SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr,
                                 nullptr));
    if (!scaler_) Check(AVERROR(EINVAL), "convert the colours of");
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  }

  void Encode(const AVFrame* frame) {
    Check(avcodec_send_frame(codec_.get(), frame), "encode");
    while (true) {
      const int result = avcodec_receive_packet(codec_.get(), packet_.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      Check(result, "encode");
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      Check(av_interleaved_write_frame(format_.get(), packet_.get()), "write");
    }
  }

  std::filesystem::path path_;
  NewFile file_;
  Packet packet_;
  CodecContext codec_;
  std::unique_ptr<AVFormatContext, CloseFormat> format_;
  AVStream* stream_ = nullptr;  // belongs to format_
  Frame frame_;
  std::unique_ptr<SwsContext, FreeScaler> scaler_;
  std::int64_t next_ = 0;  // index of the next picture
};

}  // namespace

std::unique_ptr<VideoWriter> MakeH264Writer(const std::filesystem::path& path, int width,
                                            int height, const VideoOptions& options) {
  av_log_set_level(AV_LOG_ERROR);  // x264 is fond of telling how well it did
  return std::make_unique<H264Writer>(path, width, height, options);
}

}  // namespace kinescope::render::av
