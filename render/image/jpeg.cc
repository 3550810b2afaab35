// clang-format off
#include <cstdio>  // first: jpeglib.h uses FILE and size_t without including anything
#include <jpeglib.h>
// clang-format on

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

}  // namespace

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
