#include "render/av/clip_reader.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "render/av/libav.h"

namespace kinescope::render::av {
namespace {

constexpr int kLargestSide = 16384;  // px; larger is no clip of ours

class ClipReader : public VideoReader {
 public:
  explicit ClipReader(const std::filesystem::path& path)
      : path_(path), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
    AVFormatContext* format = nullptr;
    Check(avformat_open_input(&format, path.c_str(), nullptr, nullptr), "read", path_);
    format_.reset(format);
    Check(avformat_find_stream_info(format, nullptr), "read", path_);
    const int index = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    Check(index, "find pictures in", path_);
    stream_ = format->streams[index];
    OpenDecoder();
  }

  bool Next(Image& image) override {
    while (true) {
      const int result = avcodec_receive_frame(decoder_.get(), frame_.get());
      if (result == AVERROR_EOF) return false;
      if (result != AVERROR(EAGAIN)) {
        Check(result, "decode", path_);
        Convert(image);
        if (first_pts_ == AV_NOPTS_VALUE) first_pts_ = frame_->best_effort_timestamp;
        secs_ = static_cast<double>(frame_->best_effort_timestamp - first_pts_) *
                av_q2d(stream_->time_base);
        return true;
      }
      Feed();
    }
  }

  double secs() const override { return secs_; }

  std::map<std::string, std::string> metadata() const override {
    std::map<std::string, std::string> found;
    const AVDictionaryEntry* entry = nullptr;
    while ((entry = av_dict_get(format_->metadata, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
      std::string key = entry->key;
      std::transform(key.begin(), key.end(), key.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      found[key] = entry->value;
    }
    return found;
  }

 private:
  void OpenDecoder() {
    const AVCodecParameters& codec = *stream_->codecpar;
    if (codec.width > kLargestSide || codec.height > kLargestSide) {
      throw std::runtime_error("cannot read " + path_.string() + ": " +
                               std::to_string(codec.width) + " x " + std::to_string(codec.height) +
                               " px is larger than the limit of " + std::to_string(kLargestSide) +
                               " px per side");
    }
    // libav's own VP9 decoder does not see the alpha channel.
    const bool has_alpha = av_dict_get(stream_->metadata, "alpha_mode", nullptr, 0) != nullptr;
    const AVCodec* decoder = has_alpha && codec.codec_id == AV_CODEC_ID_VP9
                                 ? avcodec_find_decoder_by_name("libvpx-vp9")
                                 : avcodec_find_decoder(codec.codec_id);
    if (decoder == nullptr) Check(AVERROR_DECODER_NOT_FOUND, "decode", path_);
    decoder_.reset(avcodec_alloc_context3(decoder));
    if (!decoder_) Check(AVERROR(ENOMEM), "decode", path_);
    Check(avcodec_parameters_to_context(decoder_.get(), &codec), "decode", path_);
    decoder_->thread_count = 2;
    Check(avcodec_open2(decoder_.get(), decoder, nullptr), "decode", path_);
  }

  void Feed() {
    while (true) {
      const int read = av_read_frame(format_.get(), packet_.get());
      if (read == AVERROR_EOF) {
        Check(avcodec_send_packet(decoder_.get(), nullptr), "decode", path_);
        return;
      }
      Check(read, "read", path_);
      const bool is_ours = packet_->stream_index == stream_->index;
      const int sent = is_ours ? avcodec_send_packet(decoder_.get(), packet_.get()) : 0;
      av_packet_unref(packet_.get());
      Check(sent, "decode", path_);
      if (is_ours) return;
    }
  }

  void Convert(Image& image) {
    const AVFrame& frame = *frame_;
    scaler_.reset(sws_getCachedContext(
        scaler_.release(), frame.width, frame.height, static_cast<AVPixelFormat>(frame.format),
        frame.width, frame.height, AV_PIX_FMT_RGBA, SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT,
        nullptr, nullptr, nullptr));
    if (!scaler_) Check(AVERROR(EINVAL), "convert the colours of", path_);
    const int* matrix =
        sws_getCoefficients(frame.colorspace == AVCOL_SPC_BT709 ? SWS_CS_ITU709 : SWS_CS_DEFAULT);
    sws_setColorspaceDetails(scaler_.get(), matrix, frame.color_range == AVCOL_RANGE_JPEG, matrix,
                             1, 0, 1 << 16, 1 << 16);
    image.width = frame.width;
    image.height = frame.height;
    image.rgba.resize(4 * static_cast<std::size_t>(frame.width) *
                      static_cast<std::size_t>(frame.height));
    std::uint8_t* rows[] = {image.rgba.data()};
    const int strides[] = {4 * frame.width};
    sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, rows, strides);
  }

  const std::filesystem::path path_;
  InputFormat format_;
  AVStream* stream_ = nullptr;  // belongs to format_
  CodecContext decoder_;
  Packet packet_;
  Frame frame_;
  Scaler scaler_;
  std::int64_t first_pts_ = AV_NOPTS_VALUE;
  double secs_ = 0;
};

}  // namespace

std::unique_ptr<VideoReader> OpenClip(const std::filesystem::path& path) {
  return std::make_unique<ClipReader>(path);
}

}  // namespace kinescope::render::av
