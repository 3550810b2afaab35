// clang-format off
#include <cstdio>  // first: jpeglib.h uses FILE and size_t without including anything
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <stdexcept>

#include "core/system/check.h"
#include "render/image/png_file.h"

namespace kinescope::render {
namespace {

struct ErrorHandler {
  jpeg_error_mgr manager;  // first: libjpeg hands back a pointer to it
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void Escape(j_common_ptr state) {
  auto* handler = reinterpret_cast<ErrorHandler*>(state->err);
  state->err->format_message(state, handler->message);
  std::longjmp(handler->escape, 1);
}

struct Encoder {
  jpeg_compress_struct state = {};
  ErrorHandler error = {};
  unsigned char* bytes = nullptr;  // malloc'ed by libjpeg
  unsigned long size = 0;
  ~Encoder() {
    jpeg_destroy_compress(&state);
    std::free(bytes);
  }
};

// Nothing here has a destructor, so longjmp skips none.
bool RunJpegEncoder(Encoder& encoder, const Image& image, int quality) {
  jpeg_compress_struct& state = encoder.state;
  state.err = jpeg_std_error(&encoder.error.manager);
  state.err->error_exit = Escape;
  if (setjmp(encoder.error.escape) != 0) return false;
  jpeg_create_compress(&state);
  jpeg_mem_dest(&state, &encoder.bytes, &encoder.size);
  state.image_width = static_cast<JDIMENSION>(image.width);
  state.image_height = static_cast<JDIMENSION>(image.height);
  state.input_components = 4;
  state.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&state);  // YCbCr, 4:2:0, baseline
  jpeg_set_quality(&state, quality, TRUE);
  jpeg_start_compress(&state, TRUE);
  while (state.next_scanline < state.image_height) {
    auto* row =
        const_cast<JSAMPROW>(image.rgba.data()) +
        4 * static_cast<std::size_t>(state.next_scanline) * static_cast<std::size_t>(image.width);
    jpeg_write_scanlines(&state, &row, 1);
  }
  jpeg_finish_compress(&state);
  return true;
}

struct Decoder {
  jpeg_decompress_struct state = {};
  jpeg_progress_mgr progress = {};
  ErrorHandler error = {};
  const char* refusal = nullptr;
  ~Decoder() { jpeg_destroy_decompress(&state); }
};

// A damaged picture is grey from there on, as viewers show it, and no line on the terminal.
void SayNothing(j_common_ptr /*state*/, int /*level*/) {}

// A small file may ask for any number of passes over the whole picture.
void CheckScans(j_common_ptr state) {
  constexpr int kMostScans = 20;
  const auto* const decoder = reinterpret_cast<jpeg_decompress_struct*>(state);
  if (decoder->input_scan_number <= kMostScans) return;
  auto* const handler = reinterpret_cast<ErrorHandler*>(state->err);
  std::snprintf(handler->message, sizeof handler->message, "more than %d scans", kMostScans);
  std::longjmp(handler->escape, 1);
}

// Nothing here has a destructor; `image` belongs to the caller.
bool RunJpegDecoder(Decoder& decoder, const std::uint8_t* bytes, std::size_t size, int enough_px,
                    Image& image) {
  constexpr JDIMENSION kMostSide = 8'192;
  constexpr long kMostMemory = 128L << 20;  // bytes, of the coefficients of a progressive picture
  jpeg_decompress_struct& state = decoder.state;
  state.err = jpeg_std_error(&decoder.error.manager);
  state.err->error_exit = Escape;
  state.err->emit_message = SayNothing;
  if (setjmp(decoder.error.escape) != 0) return false;
  jpeg_create_decompress(&state);
  state.mem->max_memory_to_use = kMostMemory;
  decoder.progress.progress_monitor = CheckScans;
  state.progress = &decoder.progress;
  jpeg_mem_src(&state, bytes, static_cast<unsigned long>(size));
  jpeg_read_header(&state, TRUE);
  if (state.image_width > kMostSide || state.image_height > kMostSide) {
    decoder.refusal = "more than 8192 px a side";
    return false;
  }
  const auto longest = static_cast<int>(std::max(state.image_width, state.image_height));
  state.scale_num = 8;
  state.scale_denom = 8;
  while (state.scale_num > 1 && longest * static_cast<int>(state.scale_num) / 16 >= enough_px) {
    state.scale_num /= 2;
  }
  state.out_color_space = JCS_EXT_RGBX;
  jpeg_start_decompress(&state);
  SetSize(image, static_cast<int>(state.output_width), static_cast<int>(state.output_height));
  while (state.output_scanline < state.output_height) {
    JSAMPROW row = image.rgba.data() + 4 * static_cast<std::size_t>(state.output_scanline) *
                                           static_cast<std::size_t>(image.width);
    jpeg_read_scanlines(&state, &row, 1);
  }
  jpeg_finish_decompress(&state);
  return true;
}

}  // namespace

Image ReadJpeg(const std::uint8_t* bytes, std::size_t size, int enough_px) {
  Decoder decoder;
  Image image;
  if (!RunJpegDecoder(decoder, bytes, size, enough_px, image)) {
    throw std::runtime_error(std::string("JPEG: ") + (decoder.refusal != nullptr
                                                          ? decoder.refusal
                                                          : decoder.error.message));
  }
  image.is_opaque = true;
  return image;
}

std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality) {
  KINESCOPE_CHECK(quality >= 1 && quality <= 100);
  KINESCOPE_CHECK(image.rgba.size() == 4 * static_cast<std::size_t>(image.width) *
                                           static_cast<std::size_t>(image.height));
  Encoder encoder;
  if (!RunJpegEncoder(encoder, image, quality)) {
    throw std::runtime_error(std::string("libjpeg cannot encode the picture: ") +
                             encoder.error.message);
  }
  return {encoder.bytes, encoder.bytes + encoder.size};
}

}  // namespace kinescope::render
