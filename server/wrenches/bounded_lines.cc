#include "server/wrenches/bounded_lines.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <utility>

#include "core/system/errors.h"
#include "core/system/starts_with.h"

namespace kinescope::wrenches {

BoundedLines::BoundedLines(InputFile file, std::string name)
    : file_(std::move(file)), name_(std::move(name)), buffer_(2 * kLongestLine) {}

void BoundedLines::Refuse(const std::string& problem) const {
  throw SourceError(fmt::format("{}: line {}: {}", name_, number_, problem));
}

void BoundedLines::RefuseFile(const std::string& problem) const {
  throw SourceError(name_ + ": " + problem);
}

// False at the end of the file.
bool BoundedLines::Fill() {
  if (ended_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count =
      std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  if (count == 0 && std::ferror(file_.get()) != 0) {
    RefuseFile("cannot read the file: " + file_.failure());
  }
  end_ += count;
  ended_ = count == 0;
  return count > 0;
}

std::optional<std::string_view> BoundedLines::Next() {
  std::size_t searched = 0;
  const char* found = nullptr;
  ++number_;
  while (found == nullptr) {
    const char* const from = buffer_.data() + begin_;
    found = static_cast<const char*>(std::memchr(from + searched, '\n', end_ - begin_ - searched));
    if (found != nullptr) break;
    searched = end_ - begin_;
    if (searched > kLongestLine) break;
    if (!Fill()) break;
  }
  const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
  std::string_view line = rest;
  if (found != nullptr) line = rest.substr(0, static_cast<std::size_t>(found - rest.data()));
  if (line.size() > kLongestLine) {
    Refuse(fmt::format("longer than {} bytes; expected a table of numbers", kLongestLine));
  }
  if (found == nullptr && line.empty()) {
    --number_;
    return std::nullopt;
  }
  begin_ += line.size() + (found != nullptr ? 1 : 0);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (number_ == 1 && StartsWith(line, kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  return line;
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string quoted = "'";
  for (const char c : text.substr(0, kMost)) quoted += c >= ' ' && c <= '~' ? c : '?';
  return quoted + (text.size() > kMost ? "...'" : "'");
}

}  // namespace kinescope::wrenches
