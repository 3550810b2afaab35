#include "server/mvn/stream_framer.h"

#include <algorithm>
#include <utility>

#include "server/mvn/datagram_extent.h"

namespace kinescope::mvn {
namespace {

// Foreign bytes are returned in pieces of at most this size.
constexpr std::size_t kLargestForeign = 65536;

// Whether it is text of another program, and not the rest of a corrupt datagram. A text that begins
// like JSON or XML may contain any letters.
bool LooksLikeText(std::string_view bytes) {
  const std::size_t first = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size() - 1);
  const bool has_markup = std::string_view("{[<").find(bytes[first]) != std::string_view::npos;
  return std::all_of(bytes.begin(), bytes.end(), [has_markup](char c) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x80) return has_markup;
    return (code >= 0x20 && code < 0x7F) || c == '\t' || c == '\r' || c == '\n';
  });
}

}  // namespace

StreamFramer::StreamFramer() { buffer_.reserve(2 * kLargestExtent); }

void StreamFramer::Append(std::string_view bytes) {
  // StepBack() may need the last bytes that were returned.
  const std::size_t used = start_ - std::min(start_, kIdStringBytes);
  if (start_ == buffer_.size() || buffer_.size() + bytes.size() > buffer_.capacity()) {
    buffer_.erase(0, used);
    start_ -= used;
  }
  buffer_.append(bytes);
}

void StreamFramer::End() { has_ended_ = true; }

std::optional<std::string_view> StreamFramer::Next() {
  while (start_ < buffer_.size()) {
    const Match match = MatchIdString(left());
    if (match == Match::kPartial && !has_ended_) return std::nullopt;
    if (match == Match::kYes) {
      const auto size = DatagramSize();
      if (!size) return std::nullopt;
      return Take(*size, true);
    }
    const auto back = StepBack();
    if (!back) return std::nullopt;
    if (*back > 0) continue;
    const auto size = SizeOfForeign();
    if (!size) return std::nullopt;
    const std::string_view foreign = Take(*size, false);
    if (LooksLikeText(foreign)) return foreign;
    skipped_bytes_ += foreign.size();
    has_short_items_.reset();  // this may be why the position was wrong
  }
  return std::nullopt;
}

std::string_view StreamFramer::Take(std::size_t size, bool is_datagram) {
  const std::string_view taken = left().substr(0, size);
  start_ += size;
  searched_ = 0;
  last_size_ = is_datagram ? size : 0;
  return taken;
}

// The length of the datagram at the beginning of the remaining bytes.
std::optional<std::size_t> StreamFramer::DatagramSize() {
  const std::string_view bytes = left();
  const auto type = static_cast<std::size_t>(TypeNumber(bytes));
  Extent extent = ExtentOf(bytes);
  if (extent.short_size > 0 && has_short_items_.test(type)) {
    extent.size = std::exchange(extent.short_size, 0);
  }
  const bool has_size = extent.kind == Extent::Kind::kSize;
  const std::size_t end = has_size ? extent.size : kLargestExtent;
  if (const auto cut = FindInnerDatagram(bytes, end, searched_)) {
    if (*cut == extent.short_size) {
      has_short_items_.set(type);
    } else if (extent.kind != Extent::Kind::kOpen || *cut < kHeaderBytes) {
      ++resyncs_;
    }
    return cut;
  }
  // Without a size, the bytes after the header are searched as foreign.
  if (bytes.size() >= end) return has_size ? end : kHeaderBytes;
  if (!has_ended_) return std::nullopt;
  const bool is_short = extent.short_size > 0 && bytes.size() >= extent.short_size &&
                        MatchIdString(bytes.substr(extent.short_size)) != Match::kNo;
  return is_short ? extent.short_size : bytes.size();
}

// The number of remaining bytes before the next datagram that belong to none.
std::optional<std::size_t> StreamFramer::SizeOfForeign() {
  const std::string_view bytes = left().substr(0, kLargestForeign + kIdStringBytes);
  const std::size_t from = std::max<std::size_t>(searched_, 1);
  std::size_t size = FindIdString(bytes, from);
  if (size == std::string_view::npos) {
    if (bytes.size() < kLargestForeign + kIdStringBytes && !has_ended_) {
      searched_ = SearchedIn(bytes, from);
      return std::nullopt;
    }
    size = std::min(bytes.size(), kLargestForeign);
  }
  if (last_size_ > 0 || start_ == 0) ++resyncs_;
  return size;
}

// If foreign bytes follow a datagram, it may have contained the first bytes of the next one: goes
// back to them and returns by how many bytes; nullopt: more bytes are needed.
std::optional<std::size_t> StreamFramer::StepBack() {
  const std::size_t most =
      std::min(kIdStringBytes, last_size_ - std::min(last_size_, kIdStringBytes));
  for (std::size_t back = most; back > 0; --back) {
    const Match match = MatchIdString(std::string_view(buffer_).substr(start_ - back));
    if (match == Match::kPartial && !has_ended_) return std::nullopt;
    if (match != Match::kYes) continue;
    start_ -= back;
    reread_bytes_ += back;
    ++resyncs_;
    searched_ = 0;
    last_size_ = 0;
    return back;
  }
  return 0;
}

}  // namespace kinescope::mvn
