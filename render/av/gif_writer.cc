#include "render/av/gif_writer.h"

extern "C" {
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
}

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/av/libav.h"
#include "render/av/spool.h"
#include "render/image/new_file.h"

namespace kinescope::render::av {
namespace {

constexpr AVPixelFormat kPictures = AV_PIX_FMT_ARGB;
constexpr AVRational kTick = {1, 100};  // a GIF counts hundredths of a second

// A chain of filters with one or two inputs and one output.
class Filters {
 public:
  // `description` names its inputs in0, in1 and its output out.
  Filters(const std::string& description, const std::vector<std::pair<int, int>>& input_sizes,
          const std::filesystem::path& path)
      : path_(path), graph_(avfilter_graph_alloc()) {
    if (!graph_) Check(AVERROR(ENOMEM), "filter pictures of", path_);
    graph_->nb_threads = 1;
    AVFilterInOut* outputs = nullptr;  // ours, which the description's inputs are joined to
    for (std::size_t i = input_sizes.size(); i-- > 0;) {
      const std::string name = "in" + std::to_string(i);
      const std::string arguments =
          "width=" + std::to_string(input_sizes[i].first) +
          ":height=" + std::to_string(input_sizes[i].second) +
          ":pix_fmt=" + std::to_string(i == 0 ? kPictures : AV_PIX_FMT_RGB32) + ":time_base=1/100";
      AVFilterContext* source = nullptr;
      Check(avfilter_graph_create_filter(&source, avfilter_get_by_name("buffer"), name.c_str(),
                                         arguments.c_str(), nullptr, graph_.get()),
            "filter pictures of", path_);
      sources_.insert(sources_.begin(), source);
      outputs = MakeEnd(name, source, outputs);
    }
    Check(avfilter_graph_create_filter(&sink_, avfilter_get_by_name("buffersink"), "out", nullptr,
                                       nullptr, graph_.get()),
          "filter pictures of", path_);
    AVFilterInOut* inputs = MakeEnd("out", sink_, nullptr);
    const int parsed =
        avfilter_graph_parse_ptr(graph_.get(), description.c_str(), &inputs, &outputs, nullptr);
    avfilter_inout_free(&inputs);
    avfilter_inout_free(&outputs);
    Check(parsed, "filter pictures of", path_);
    Check(avfilter_graph_config(graph_.get(), nullptr), "filter pictures of", path_);
  }

  // `frame` null: there are no more.
  void Put(std::size_t input, AVFrame* frame) {
    Check(av_buffersrc_add_frame_flags(sources_.at(input), frame, AV_BUFFERSRC_FLAG_KEEP_REF),
          "filter pictures of", path_);
  }

  bool Take(AVFrame* frame) {
    av_frame_unref(frame);
    const int result = av_buffersink_get_frame(sink_, frame);
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return false;
    Check(result, "filter pictures of", path_);
    return true;
  }

 private:
  AVFilterInOut* MakeEnd(const std::string& name, AVFilterContext* filter, AVFilterInOut* next) {
    AVFilterInOut* end = avfilter_inout_alloc();
    if (end == nullptr) Check(AVERROR(ENOMEM), "filter pictures of", path_);
    *end = {av_strdup(name.c_str()), filter, 0, next};
    return end;
  }

  std::filesystem::path path_;
  FilterGraph graph_;
  std::vector<AVFilterContext*> sources_;  // belong to graph_
  AVFilterContext* sink_ = nullptr;        // belongs to graph_
};

class GifWriter : public VideoWriter {
 public:
  GifWriter(const std::filesystem::path& path, int width, int height, const VideoOptions& options)
      : path_(path),
        encoder_(FindEncoder("gif", "libavcodec59", path)),
        options_(options),
        file_(path),
        spool_(path, kPictures, width, height),
        frame_(MakeFrame(kPictures, width, height, path)),
        scaler_(sws_getContext(width, height, AV_PIX_FMT_RGBA, width, height, kPictures, SWS_POINT,
                               nullptr, nullptr, nullptr)) {
    if (!scaler_) Check(AVERROR(EINVAL), "convert the colours of", path_);
  }

  void Add(const Image& image) override {
    CheckSameSize(image, frame_->width, frame_->height, path_);
    if (!palette_maker_) {
      has_alpha_ = options_.alpha.value_or(HasHoles(image));
      palette_maker_ = std::make_unique<Filters>(
          "[in0]palettegen=stats_mode=full:reserve_transparent=" + std::to_string(has_alpha_) +
              "[out]",
          std::vector<std::pair<int, int>>{{frame_->width, frame_->height}}, path_);
    }
    Check(av_frame_make_writable(frame_.get()), "allocate pictures of", path_);
    const std::uint8_t* rows[] = {image.rgba.data()};
    const int strides[] = {4 * image.width};
    sws_scale(scaler_.get(), rows, strides, 0, image.height, frame_->data, frame_->linesize);
    frame_->pts = next_++;
    spool_.Add(*frame_);
    palette_maker_->Put(0, frame_.get());
  }

  void Finish() override {
    if (next_ == 0) throw std::runtime_error(path_.string() + ": a clip needs at least one frame");
    palette_maker_->Put(0, nullptr);
    Frame palette(av_frame_alloc());
    if (!palette_maker_->Take(palette.get())) Check(AVERROR_BUG, "choose the colours of", path_);
    palette_maker_.reset();
    OpenEncoder();
    OpenContainer();
    // Ordered dither: a still floor stays still, which error diffusion does not let it.
    Filters painter("[in0][in1]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle[out]",
                    {{frame_->width, frame_->height}, {palette->width, palette->height}}, path_);
    palette->pts = 0;
    painter.Put(1, palette.get());
    painter.Put(1, nullptr);
    Frame painted(av_frame_alloc());
    spool_.Rewind();
    for (std::int64_t k = 0; k < next_; ++k) {
      AVFrame& picture = spool_.Next();
      picture.pts = TickOf(k);
      painter.Put(0, &picture);
      while (painter.Take(painted.get())) Encode(painted.get());
    }
    painter.Put(0, nullptr);
    while (painter.Take(painted.get())) Encode(painted.get());
    Encode(nullptr);
    Close();
  }

 private:
  static bool HasHoles(const Image& image) {
    for (std::size_t at = 3; at < image.rgba.size(); at += 4) {
      if (image.rgba[at] < 128) return true;
    }
    return false;
  }

  std::int64_t TickOf(std::int64_t k) const {
    constexpr std::int64_t kNanosPerTick = 10'000'000;
    return (options_.rate.NanosOf(k) + kNanosPerTick / 2) / kNanosPerTick;
  }

  void OpenEncoder() {
    codec_.reset(avcodec_alloc_context3(&encoder_));
    if (!codec_) Check(AVERROR(ENOMEM), "encode", path_);
    codec_->width = frame_->width;
    codec_->height = frame_->height;
    codec_->pix_fmt = AV_PIX_FMT_PAL8;
    codec_->time_base = kTick;
    Check(avcodec_open2(codec_.get(), &encoder_, nullptr), "encode", path_);
  }

  void OpenContainer() {
    const std::string url = file_.open_path();
    AVFormatContext* format = nullptr;
    Check(avformat_alloc_output_context2(&format, nullptr, "gif", url.c_str()), "write", path_);
    format_.reset(format);
    format_->flags |= AVFMT_FLAG_BITEXACT;
    stream_ = avformat_new_stream(format_.get(), nullptr);
    if (stream_ == nullptr) Check(AVERROR(ENOMEM), "write", path_);
    Check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "write", path_);
    stream_->time_base = kTick;
    Check(avio_open(&format_->pb, url.c_str(), AVIO_FLAG_WRITE), "write", path_);
    AVDictionary* muxer = nullptr;
    const std::int64_t last = TickOf(next_) - TickOf(next_ - 1);
    av_dict_set_int(&muxer, "final_delay", last, 0);
    const int result = avformat_write_header(format_.get(), &muxer);
    av_dict_free(&muxer);
    Check(result, "write", path_);
  }

  void Encode(const AVFrame* frame) {
    Check(avcodec_send_frame(codec_.get(), frame), "encode", path_);
    Packet packet(av_packet_alloc());
    while (true) {
      const int result = avcodec_receive_packet(codec_.get(), packet.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      Check(result, "encode", path_);
      packet->stream_index = stream_->index;
      Check(av_interleaved_write_frame(format_.get(), packet.get()), "write", path_);
      Check(format_->pb->error, "write", path_);
    }
  }

  void Close() {
    Check(av_write_trailer(format_.get()), "finish", path_);
    avio_flush(format_->pb);
    Check(format_->pb->error, "write", path_);
    Check(avio_closep(&format_->pb), "close", path_);
    const auto comment = options_.metadata.find("comment");
    if (comment != options_.metadata.end()) WriteComment(comment->second);
    file_.Commit();
  }

  // libav's muxer writes none. GIF89a: a comment extension is 0x21 0xFE, blocks of at most 255
  // bytes each behind its length, and 0; it may stand before the trailer, 0x3B.
  void WriteComment(const std::string& text) const {
    constexpr std::size_t kLargestBlock = 255;
    constexpr char kTrailer = 0x3B;
    std::string extension = "\x21\xFE";
    for (std::size_t at = 0; at < text.size(); at += kLargestBlock) {
      const std::string block = text.substr(at, kLargestBlock);
      extension += static_cast<char>(block.size());
      extension += block;
    }
    extension += '\0';
    extension += kTrailer;
    std::fstream file(file_.open_path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(-1, std::ios::end);
    if (file.get() != kTrailer) Check(AVERROR_BUG, "finish", path_);
    file.seekp(-1, std::ios::end);
    file << extension << std::flush;
    if (!file)
      throw std::runtime_error("cannot write " + path_.string() +
                               ": write error; check the free disk space");
  }

  const std::filesystem::path path_;
  const AVCodec& encoder_;
  const VideoOptions options_;
  NewFile file_;
  Spool spool_;
  Frame frame_;
  Scaler scaler_;
  bool has_alpha_ = false;
  std::unique_ptr<Filters> palette_maker_;  // from the first picture to the last
  std::int64_t next_ = 0;                   // index of the next picture
  // From the last picture on.
  CodecContext codec_;
  OutputFormat format_;
  AVStream* stream_ = nullptr;  // belongs to format_
};

}  // namespace

std::unique_ptr<VideoWriter> MakeGifWriter(const std::filesystem::path& path, int width, int height,
                                           const VideoOptions& options) {
  return std::make_unique<GifWriter>(path, width, height, options);
}

}  // namespace kinescope::render::av
