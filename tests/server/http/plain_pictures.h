/// Pictures of one colour: stand-ins for the renderer's, which the page only shows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kinescope::http::testing {

std::vector<std::uint8_t> PlainJpeg(int width, int height, std::array<std::uint8_t, 3> rgb);
std::vector<std::uint8_t> PlainPng(int width, int height, std::array<std::uint8_t, 3> rgb);

}  // namespace kinescope::http::testing
