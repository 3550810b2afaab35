#include "render/av/codec_writer.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "render/av/hidden_color.h"
#include "render/av/libav.h"
#include "render/image/new_file.h"
#include "render/image/yuv.h"

namespace kinescope::render::av {
namespace {

// Fixed numbers, so that a clip does not depend on the machine: encoders decide a little
// differently for every count of threads.
constexpr int kEncoderThreads = 4;
// Two threads of x264 encode faster than pictures are drawn; two more cost a twentieth of its time,
// and 20 MB at 1280 x 720. Of 4K, where a thread costs 100 MB, even one is fast enough.
constexpr int kX264Threads = 2, kX264ThreadsOfLarge = 1;
constexpr int kLargePx = 1920 * 1088;

// To seek, a player decodes the pictures since the key picture before: at most a quarter of a
// second of work. A clip with one every 2 s is a fifth larger (tests/bench/README.md).
constexpr double kKeySecs = 5, kFormerKeySecs = 2;
constexpr int kMostFromKeyToKey = 250;

// x264 (build 164) works through a row of its macroblock tree in steps of eight macroblocks. In a
// row of another length it reads on behind the end, and two clips of the same pictures differ. Such
// clips are made without the tree.
constexpr int kTreeStepPx = 8 * 16;

struct Setting {
  const char* name;
  const char* value;
};

// What tells one format from the other.
struct Recipe {
  const char* encoder;
  const char* package;  // Debian's, that has the encoder
  const char* container;
  int default_crf;
  bool keeps_alpha;
  std::vector<Setting> encoder_settings;
  std::vector<Setting> container_settings;
};

Recipe RecipeOf(ClipFormat format) {
  if (format == ClipFormat::kMp4) {
    return {"libx264",
            "libavcodec59 with libx264-164",
            "mp4",
            18,
            false,
            {{"preset", "veryfast"}},
            {{"movflags", "+faststart"}}};
  }
  // Tiles, not rows, are what its threads share: these give the same bytes whatever the load.
  return {"libvpx-vp9",
          "libavcodec59 with libvpx7",
          "webm",
          24,
          true,
          {{"deadline", "good"}, {"cpu-used", "4"}, {"row-mt", "0"}, {"tile-columns", "2"}},
          {}};
}

class CodecWriter : public VideoWriter {
 public:
  CodecWriter(const std::filesystem::path& path, ClipFormat format, int width, int height,
              const VideoOptions& options)
      : path_(path),
        recipe_(RecipeOf(format)),
        encoder_(FindEncoder(recipe_.encoder, recipe_.package, path)),
        width_(width),
        height_(height),
        options_(options),
        file_(path),
        packet_(av_packet_alloc()) {
    if (options.alpha) Open(*options.alpha);
  }

  void Add(const Image& image) override {
    CheckSameSize(image, width_, height_, path_);
    const bool is_opaque = IsOpaque(image);
    if (!codec_) Open(!is_opaque);
    if (!is_opaque && !has_alpha_) RefuseAlpha();
    Check(av_frame_make_writable(frame_.get()), "allocate pictures of", path_);
    if (has_alpha_) {
      glass_ = image;
      HideColors(glass_);
      CopyAlpha(glass_, frame_->data[3], frame_->linesize[3]);
    }
    Convert(has_alpha_ ? glass_ : image);
    frame_->pts = next_++;
    Encode(frame_.get());
  }

  void Finish() override {
    if (next_ == 0) throw std::runtime_error(path_.string() + ": a clip needs at least one frame");
    Encode(nullptr);
    Check(av_write_trailer(format_.get()), "finish", path_);
    avio_flush(format_->pb);
    Check(format_->pb->error, "write", path_);
    Check(avio_closep(&format_->pb), "close", path_);
    file_.Commit();
  }

 private:
  [[noreturn]] void RefuseAlpha() const {
    if (!recipe_.keeps_alpha) {
      throw std::runtime_error(path_.string() +
                               ": H.264 does not support transparency; use .webm, .webp or .gif");
    }
    throw std::runtime_error(
        path_.string() + ": a frame is transparent, but the first frame of the clip was opaque");
  }

  void Open(bool has_alpha) {
    if (has_alpha && !recipe_.keeps_alpha) RefuseAlpha();
    has_alpha_ = has_alpha;
    OpenEncoder();
    OpenContainer();
    frame_ = MakeFrame(codec_->pix_fmt, width_, height_, path_);
  }

  // Only where the picture before, whose planes the frame still has, or this one are not floor.
  void Convert(const Image& image) {
    const YuvPlanes planes = {frame_->data[0],     frame_->data[1],     frame_->data[2],
                              frame_->linesize[0], frame_->linesize[1], frame_->linesize[2]};
    if (image.floor != nullptr && image.floor == floor_) {
      changed_.Add(image.changed);
      for (const Tile& part : changed_.Rectangles()) {
        ToYuv(image, part.x, part.y, part.width, part.height, planes);
      }
    } else {
      ToYuv(image, 0, 0, width_, height_, planes);
    }
    floor_ = image.floor;
    changed_ = image.changed;
  }

  bool is_x264() const { return std::string_view(recipe_.encoder) == "libx264"; }
  bool is_former() const { return options_.encoding < kClipEncoding; }

  // In pictures.
  int KeyDistance() const {
    const double hz = options_.rate.hz();
    if (is_former()) return std::max(1, static_cast<int>(std::lround(kFormerKeySecs * hz)));
    return std::clamp(static_cast<int>(std::lround(kKeySecs * hz)), 1, kMostFromKeyToKey);
  }

  int EncoderThreads() const {
    if (!is_x264() || is_former()) return kEncoderThreads;
    return is_large() ? kX264ThreadsOfLarge : kX264Threads;
  }

  bool is_large() const { return width_ * height_ > kLargePx; }

  // Motion is refined less than by the preset, and no fading is looked for: our pictures are drawn
  // without noise. Takes a quarter off x264's time, and adds 4 to 8 % to the file.
  std::string X264Settings() const {
    std::string settings = is_former() ? "" : "subme=1:weightp=0:";
    // Each picture that x264 looks ahead to is 24 MB of memory at 4K.
    if (!is_former() && is_large()) settings += "rc-lookahead=2:bframes=1:";
    if (width_ % kTreeStepPx != 0) settings += "mbtree=0:";
    return settings;
  }

  void OpenEncoder() {
    codec_.reset(avcodec_alloc_context3(&encoder_));
    if (!codec_) Check(AVERROR(ENOMEM), "encode", path_);
    const AVRational rate = {options_.rate.numerator, options_.rate.denominator};
    codec_->width = width_;
    codec_->height = height_;
    codec_->pix_fmt = has_alpha_ ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
    codec_->framerate = rate;
    codec_->time_base = av_inv_q(rate);
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->gop_size = KeyDistance();
    codec_->thread_count = EncoderThreads();
    codec_->bit_rate = 0;  // quality decides, not a rate
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    const auto set = [&](const char* name, const std::string& value) {
      Check(av_opt_set(codec_->priv_data, name, value.c_str(), 0), "configure", path_);
    };
    for (const Setting& each : recipe_.encoder_settings) set(each.name, each.value);
    if (is_x264()) set("x264-params", X264Settings());
    set("crf", std::to_string(options_.crf.value_or(recipe_.default_crf)));
    if (has_alpha_) set("auto-alt-ref", "0");  // libvpx has no alternate frames with alpha
    Check(avcodec_open2(codec_.get(), &encoder_, nullptr), "encode", path_);
  }

  void OpenContainer() {
    const std::string url = file_.open_path();
    AVFormatContext* format = nullptr;
    Check(avformat_alloc_output_context2(&format, nullptr, recipe_.container, url.c_str()), "write",
          path_);
    format_.reset(format);
    format_->flags |= AVFMT_FLAG_BITEXACT;  // no version strings: the same clip is the same bytes
    stream_ = avformat_new_stream(format_.get(), nullptr);
    if (stream_ == nullptr) Check(AVERROR(ENOMEM), "write", path_);
    Check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "write", path_);
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = stream_->r_frame_rate = codec_->framerate;
    for (const auto& [key, value] : options_.metadata) {
      Check(av_dict_set(&format_->metadata, key.c_str(), value.c_str(), 0), "tag", path_);
    }
    Check(avio_open(&format_->pb, url.c_str(), AVIO_FLAG_WRITE), "write", path_);
    AVDictionary* muxer = nullptr;
    for (const Setting& each : recipe_.container_settings) {
      av_dict_set(&muxer, each.name, each.value, 0);
    }
    const int result = avformat_write_header(format_.get(), &muxer);
    av_dict_free(&muxer);
    Check(result, "write", path_);
  }

  void Encode(const AVFrame* frame) {
    Check(avcodec_send_frame(codec_.get(), frame), "encode", path_);
    while (true) {
      const int result = avcodec_receive_packet(codec_.get(), packet_.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      Check(result, "encode", path_);
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      Check(av_interleaved_write_frame(format_.get(), packet_.get()), "write", path_);
      Check(format_->pb->error, "write", path_);  // reports a full disk here, hours before the end
    }
  }

  const std::filesystem::path path_;
  const Recipe recipe_;
  const AVCodec& encoder_;
  const int width_, height_;
  const VideoOptions options_;
  NewFile file_;
  Packet packet_;
  bool has_alpha_ = false;
  // From the first picture on.
  CodecContext codec_;
  OutputFormat format_;
  AVStream* stream_ = nullptr;  // belongs to format_
  Frame frame_;
  // Of the picture before, which the frame has.
  SharedPixels floor_;
  CellSet changed_;
  Image glass_;            // the picture in hand, with alpha
  std::int64_t next_ = 0;  // index of the next picture
};

}  // namespace

std::unique_ptr<VideoWriter> MakeCodecWriter(const std::filesystem::path& path, ClipFormat format,
                                             int width, int height, const VideoOptions& options) {
  return std::make_unique<CodecWriter>(path, format, width, height, options);
}

}  // namespace kinescope::render::av
