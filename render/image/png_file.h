/// Writes PNG and JPEG from an Image, and reads both (libpng, libjpeg-turbo). Pure functions apart
/// from files, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace kinescope::render {

/// RGB (without alpha if every pixel is opaque); `text` becomes tEXt chunks. The file gets its name
/// only when complete.
/// @param px_per_m  where it is printed (chunk pHYs); 0: not known
/// @throws std::runtime_error with the path and the reason.
void WritePng(const std::filesystem::path& path, const Image& image,
              const std::map<std::string, std::string>& text = {}, double px_per_m = 0);
std::vector<std::uint8_t> EncodePng(const Image& image,
                                    const std::map<std::string, std::string>& text = {},
                                    double px_per_m = 0);

/// @throws std::runtime_error with the path and the reason.
Image ReadPng(const std::filesystem::path& path);

struct PngPixels {
  int width = 0, height = 0;
  bool is_grey16 = false;           // numbers of two bytes, the low one first; else RGBA
  std::vector<std::uint8_t> bytes;  // row by row
};

/// Of untrusted bytes. Grey of 16 bits, as depth cameras send it, keeps its numbers.
/// @throws std::runtime_error with the reason: no PNG, damaged, or more than 16,384 px a side or
/// 4096 x 4096 in all
PngPixels ReadPngPixels(const std::uint8_t* bytes, std::size_t size);

/// The tEXt, zTXt and iTXt chunks before the pixels. @throws std::runtime_error with the path and
/// the reason.
std::map<std::string, std::string> ReadPngText(const std::filesystem::path& path);

/// Baseline JPEG, 4:2:0. quality 1..100.
std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality);

/// Of untrusted bytes. A larger picture is read at a half, a quarter or an eighth of its size, as
/// long as it stays larger than `enough_px` one way. Opaque.
/// @throws std::runtime_error with the reason: no JPEG, damaged, or more than 8,192 px a side
Image ReadJpeg(const std::uint8_t* bytes, std::size_t size, int enough_px);

}  // namespace kinescope::render
