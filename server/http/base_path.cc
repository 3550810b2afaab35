#include "server/http/base_path.h"

#include <algorithm>

#include "core/system/errors.h"

namespace kinescope::http {
namespace {

bool IsPlain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         std::string_view("-._~").find(c) != std::string_view::npos;
}

// Of "/a/b", without the first "/".
bool HasPlainSegments(std::string_view path) {
  while (true) {
    const std::size_t end = std::min(path.find('/'), path.size());
    const std::string_view segment = path.substr(0, end);
    if (segment.empty() || segment == "." || segment == "..") return false;
    if (!std::all_of(segment.begin(), segment.end(), IsPlain)) return false;
    if (end == path.size()) return true;
    path.remove_prefix(end + 1);
  }
}

}  // namespace

std::string CheckedBasePath(const std::string& text) {
  std::string path = text;
  if (!path.empty() && path.back() == '/') path.pop_back();
  if (path.empty()) return path;
  if (path.front() != '/' || path.size() > kMaxBasePathBytes || !HasPlainSegments(path.substr(1))) {
    throw UsageError("--base_path=" + text +
                     ": expected such as /lab3 or /tools/kinescope, of letters, digits and -._~");
  }
  return path;
}

std::optional<std::string> WithoutBasePath(std::string_view target, const std::string& base_path) {
  if (base_path.empty() || target.substr(0, base_path.size()) != base_path) {
    return std::string(target);
  }
  const std::string_view rest = target.substr(base_path.size());
  if (rest.empty() || rest.front() == '?') return std::nullopt;
  return std::string(rest.front() == '/' ? rest : target);
}

}  // namespace kinescope::http
