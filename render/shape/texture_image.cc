#include "render/shape/texture_image.h"

#include <stdexcept>
#include <utility>

#include "render/image/png_file.h"

namespace kinescope::render {

urdf::Texture DecodeTexture(const std::uint8_t* bytes, std::size_t size) {
  constexpr int kEnoughPx = 1024;
  constexpr std::uint8_t kJpeg[] = {0xFF, 0xD8}, kPng[] = {0x89, 'P'};
  const auto begins = [&](const std::uint8_t(&with)[2]) {
    return size > 2 && bytes[0] == with[0] && bytes[1] == with[1];
  };
  if (begins(kJpeg)) {
    Image image = ReadJpeg(bytes, size, kEnoughPx);
    return {image.width, image.height, std::move(image.rgba)};
  }
  if (!begins(kPng)) throw std::runtime_error("it is neither PNG nor JPEG");
  PngPixels pixels = ReadPngPixels(bytes, size);
  if (!pixels.is_grey16) return {pixels.width, pixels.height, std::move(pixels.bytes)};
  urdf::Texture texture{pixels.width, pixels.height, {}};
  for (std::size_t i = 0; i + 1 < pixels.bytes.size(); i += 2) {
    const std::uint8_t grey = pixels.bytes[i + 1];
    texture.rgba.insert(texture.rgba.end(), {grey, grey, grey, 255});
  }
  return texture;
}

}  // namespace kinescope::render
