#include "server/options/choose.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

namespace kinescope::app {

std::vector<std::string> SplitList(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size() && !text.empty(); ++i) {
    const std::size_t next = std::min(text.find_first_not_of(' ', i + 1), text.size());
    const bool ends =
        i == text.size() || text[i] == ';' ||
        (text[i] == ',' &&
         (next == text.size() || std::isalpha(static_cast<unsigned char>(text[next])) != 0));
    if (!ends) continue;
    parts.push_back(text.substr(begin, i - begin));
    begin = next;
  }
  return parts;
}

bool ToSwitch(const std::string& name, const std::string& on_or_off) {
  if (on_or_off == "on") return true;
  if (on_or_off == "off") return false;
  throw UsageError(fmt::format("--{}={}: expected on or off", name, on_or_off));
}

std::pair<int, int> ToSize(const std::string& name, const std::string& text) {
  int width = 0;
  int height = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool has_x = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = has_x ? std::from_chars(first.ptr + 1, end, height) : first;
  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 8192; };
  if (!has_x || second.ec != std::errc() || second.ptr != end || !fits(width) || !fits(height)) {
    throw UsageError(fmt::format(
        "--{}={}: expected WIDTHxHEIGHT, each 16 to 8192, such as 1280x720", name, text));
  }
  return {width, height};
}

}  // namespace kinescope::app
