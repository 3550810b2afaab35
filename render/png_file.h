/// PNG and JPEG out of an Image (libpng, libjpeg-turbo), PNG back in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "render/image.h"

namespace kinescope::render {

/// RGB (alpha dropped when every pixel is opaque); `text` becomes tEXt chunks. The file appears
/// under its name only when it is whole.
/// @throws std::runtime_error naming the path and the reason.
void WritePng(const std::filesystem::path& path, const Image& image,
              const std::map<std::string, std::string>& text = {});
std::vector<std::uint8_t> EncodePng(const Image& image,
                                    const std::map<std::string, std::string>& text = {});

/// @throws std::runtime_error naming the path and what is wrong with it.
Image ReadPng(const std::filesystem::path& path);

/// The tEXt, zTXt and iTXt chunks that stand before the pixels. @throws likewise.
std::map<std::string, std::string> ReadPngText(const std::filesystem::path& path);

/// Baseline JPEG, 4:2:0. quality 1..100.
std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality);

}  // namespace kinescope::render
