#include "render/av/spool.h"

#include <stdexcept>

#include "core/system/check.h"

namespace kinescope::render::av {

Spool::Spool(const std::filesystem::path& beside, AVPixelFormat format, int width, int height)
    : path_(beside), file_(beside), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
  const AVCodec& codec = FindEncoder("qtrle", "libavcodec59", path_);
  encoder_.reset(avcodec_alloc_context3(&codec));
  const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_QTRLE);
  decoder_.reset(avcodec_alloc_context3(decoder));
  if (!encoder_ || !decoder_) Check(AVERROR(ENOMEM), "encode", path_);
  encoder_->width = decoder_->width = width;
  encoder_->height = decoder_->height = height;
  encoder_->pix_fmt = format;
  encoder_->time_base = {1, 1};
  decoder_->bits_per_coded_sample = 32;
  Check(avcodec_open2(encoder_.get(), &codec, nullptr), "encode", path_);
  Check(avcodec_open2(decoder_.get(), decoder, nullptr), "encode", path_);
}

void Spool::Add(const AVFrame& frame) {
  Check(avcodec_send_frame(encoder_.get(), &frame), "encode", path_);
  Keep();
}

void Spool::Keep() {
  while (true) {
    const int result = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    Check(result, "encode", path_);
    file_.Write(packet_->data, static_cast<std::size_t>(packet_->size));
    sizes_.push_back(packet_->size);
    av_packet_unref(packet_.get());
  }
}

void Spool::Rewind() {
  Check(avcodec_send_frame(encoder_.get(), nullptr), "encode", path_);
  Keep();
  in_.open(file_.open_path(), std::ios::binary);
}

AVFrame& Spool::Next() {
  while (true) {
    const int result = avcodec_receive_frame(decoder_.get(), frame_.get());
    if (result != AVERROR(EAGAIN)) {
      Check(result, "read back", path_);
      return *frame_;
    }
    KINESCOPE_CHECK(next_ < sizes_.size());
    Check(av_new_packet(packet_.get(), sizes_[next_]), "read back", path_);
    in_.read(reinterpret_cast<char*>(packet_->data), sizes_[next_]);
    if (!in_) throw std::runtime_error("cannot read back pictures of " + path_.string());
    ++next_;
    const int sent = avcodec_send_packet(decoder_.get(), packet_.get());
    av_packet_unref(packet_.get());
    Check(sent, "read back", path_);
    if (next_ == sizes_.size()) avcodec_send_packet(decoder_.get(), nullptr);
  }
}

}  // namespace kinescope::render::av
