#include "core/suit_colors.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace kinescope {

std::optional<Rgb> ColorFromHex(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + 1, end, value, 16);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  const auto channel = [&](int shift) { return (value >> shift & 0xFF) / 255.0; };
  return Rgb{channel(16), channel(8), channel(0)};
}

std::string ToHex(const Rgb& color) {
  char text[8];
  const auto byte = [](double channel) { return static_cast<int>(std::lround(255 * channel)); };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(color[0]), byte(color[1]), byte(color[2]));
  return text;
}

}  // namespace kinescope
