#include "server/http/target.h"

#include <algorithm>

namespace kinescope::http {
namespace {

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

tl::unexpected<std::string> Refuse(const char* reason) {
  return tl::unexpected(std::string(reason));
}

bool HasControlCharacter(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
}

// Every segment except the last must have a name; "/" alone is the root.
bool HasOddSegment(std::string_view path) {
  path.remove_prefix(1);
  while (true) {
    const std::size_t slash = path.find('/');
    const std::string_view segment = path.substr(0, slash);
    if (segment == "." || segment == "..") return true;
    if (slash == std::string_view::npos) return false;
    if (segment.empty()) return true;
    path.remove_prefix(slash + 1);
  }
}

}  // namespace

tl::expected<std::string, std::string> PercentDecode(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? HexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0) return Refuse("a % is not followed by two hexadecimal digits");
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

tl::expected<Target, std::string> ParseTarget(std::string_view text) {
  if (text.size() > kMaxTargetBytes) return Refuse("the address is too long");
  if (text.empty() || text.front() != '/') return Refuse("the path must begin with /");
  const std::size_t question = text.find('?');
  auto path = PercentDecode(text.substr(0, question));
  if (!path) return tl::unexpected(path.error());
  if (HasControlCharacter(*path) || path->find('\\') != std::string::npos) {
    return Refuse("the path contains an invalid character");
  }
  if (HasOddSegment(*path)) return Refuse("the path contains an empty, . or .. segment");
  Target target;
  target.path = *std::move(path);
  std::string_view rest = question == std::string_view::npos ? "" : text.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view pair = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::size_t equals = pair.find('=');
    auto name = PercentDecode(pair.substr(0, equals));
    auto value = PercentDecode(equals == std::string_view::npos ? "" : pair.substr(equals + 1));
    if (!name) return tl::unexpected(name.error());
    if (!value) return tl::unexpected(value.error());
    if (HasControlCharacter(*name) || HasControlCharacter(*value)) {
      return Refuse("the query contains a control character");
    }
    target.query.emplace(*std::move(name), *std::move(value));
  }
  return target;
}

}  // namespace kinescope::http
