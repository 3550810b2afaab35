#include "server/mvn/datagram_extent.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "server/mvn/byte_order.h"

namespace kinescope::mvn {
namespace {

constexpr std::string_view kMagic = "MXTP";
constexpr std::size_t kItemCountAt = 11;
constexpr std::size_t kPayloadSizeAt = 22;
constexpr std::size_t kLengthBytes = 4;

constexpr int kTypeMetaData = 12;
constexpr int kTypeScale = 13;
constexpr std::array<int, 15> kKnownTypes = {1, 2, 3, 4, 5, 10, 11, 12, 13, 20, 21, 22, 23, 24, 25};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

template <class Unsigned>
Unsigned ReadAt(std::string_view bytes, std::size_t offset) {
  Unsigned value = 0;
  return ByteReader(bytes.substr(offset)).Read(value) ? value : Unsigned{0};
}

// Walks through the body of a 12 or 13, at most up to `limit`, from text to text. Everything else
// in it is numbers.
class TextWalk {
 public:
  TextWalk(std::string_view bytes, int type, std::size_t limit)
      : bytes_(bytes), limit_(limit), section_(type == kTypeMetaData ? kMetaData : kSegments) {}

  enum class Step { kText, kAtEnd, kNeedMore, kBroken };

  /// Moves to the next text. Any result but kText is final.
  Step Next() {
    if (!PassNumbers(numbers_after_text_)) return Step::kBroken;
    numbers_after_text_ = 0;
    while (rows_ == 0) {
      if (section_ == kEnd) return Step::kAtEnd;
      const Step step = Begin();
      if (step != Step::kText) return step;
    }
    --rows_;
    if (!PassNumbers(row_.before)) return Step::kBroken;
    std::uint32_t size = 0;
    const Step step = ReadCount(size);
    if (step != Step::kText) return step;
    if (size > limit_ - offset_) return Step::kBroken;
    text_begin_ = offset_;
    offset_ += size;
    numbers_after_text_ = row_.after;
    return Step::kText;
  }

  /// Moves to the end of the body.
  Step GoToEnd() {
    Step step = Step::kText;
    while (step == Step::kText) step = Next();
    return step;
  }

  std::size_t text_begin() const { return text_begin_; }
  std::size_t text_end() const { return offset_; }  // at kAtEnd: end of the body

 private:
  enum Section { kMetaData, kSegments, kPoints, kEnd };
  struct Row {
    std::size_t before = 0;  // bytes of numbers before and after the text
    std::size_t after = 0;
  };

  // Begins the next section; skips sections without rows.
  Step Begin() {
    if (section_ == kMetaData) {
      rows_ = 1;
      section_ = kEnd;
      return Step::kText;
    }
    const Step step = ReadCount(rows_);
    if (step != Step::kText) return step;
    row_ = section_ == kSegments ? Row{0, 12} : Row{4, 16};
    section_ = section_ == kSegments ? kPoints : kEnd;
    return Step::kText;
  }

  bool PassNumbers(std::size_t size) {
    if (size > limit_ - offset_) return false;
    offset_ += size;
    return true;
  }

  Step ReadCount(std::uint32_t& count) {
    if (limit_ - offset_ < kLengthBytes) return Step::kBroken;
    if (offset_ + kLengthBytes > bytes_.size()) return Step::kNeedMore;
    count = ReadAt<std::uint32_t>(bytes_, offset_);
    offset_ += kLengthBytes;
    return Step::kText;
  }

  std::string_view bytes_;
  std::size_t limit_;  // at least kHeaderBytes
  Section section_;    // the next section
  Row row_;
  std::uint32_t rows_ = 0;  // left in this section
  std::size_t numbers_after_text_ = 0;
  std::size_t offset_ = kHeaderBytes;
  std::size_t text_begin_ = kHeaderBytes;
};

bool IsControl(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

enum class Inner { kDatagram, kText, kNeedMore };

// Decides what the id strings within a datagram are; call it from the first to the last.
class InnerIdStrings {
 public:
  /// For the datagram at the start of `bytes`, which would end at `end`.
  InnerIdStrings(std::string_view bytes, std::size_t end)
      : bytes_(bytes),
        type_(TypeNumber(bytes)),
        end_(std::max(end, kHeaderBytes)),
        walk_(bytes, type_, end_) {}

  Inner Judge(std::size_t position) {
    // Numbers in the range of human motion never spell an id string; only names can.
    if (type_ != kTypeMetaData && type_ != kTypeScale) return Inner::kDatagram;
    // If more bytes are needed to find the next text, the id string is within the numbers before
    // it.
    while (walk_.text_end() <= position) {
      if (walk_.Next() != TextWalk::Step::kText) return Inner::kDatagram;
    }
    if (position < walk_.text_begin() || walk_.text_end() < position + kIdStringBytes) {
      return Inner::kDatagram;
    }
    // A header contains zeros, a name does not.
    const std::string_view text = bytes_.substr(0, walk_.text_end()).substr(position);
    if (std::any_of(text.begin(), text.end(), IsControl)) return Inner::kDatagram;
    // And a name is followed by the rest of its row and more rows.
    if (!rest_) rest_ = TextWalk(walk_).GoToEnd();
    if (*rest_ == TextWalk::Step::kBroken) return Inner::kDatagram;
    const bool is_whole = *rest_ == TextWalk::Step::kAtEnd && walk_.text_end() <= bytes_.size();
    return is_whole ? Inner::kText : Inner::kNeedMore;
  }

  std::size_t text_end() const { return walk_.text_end(); }  // of the text checked last

 private:
  std::string_view bytes_;
  int type_;
  std::size_t end_;
  TextWalk walk_;
  std::optional<TextWalk::Step> rest_;  // how the walk ends
};

Extent Sized(std::size_t payload, std::size_t short_payload = 0) {
  return {Extent::Kind::kSize, kHeaderBytes + payload,
          short_payload > 0 ? kHeaderBytes + short_payload : 0};
}

Extent ExtentByWalk(std::string_view bytes, int type) {
  TextWalk walk(bytes, type, kLargestExtent);
  switch (walk.GoToEnd()) {
    case TextWalk::Step::kAtEnd: return Sized(walk.text_end() - kHeaderBytes);
    case TextWalk::Step::kNeedMore: return {Extent::Kind::kNeedMore, 0, 0};
    default: return {Extent::Kind::kBroken, 0, 0};
  }
}

// "HH:MM:SS" or "HH:MM:SS.mmm", with or without a length before it.
Extent ExtentOfTimeCode(std::string_view payload) {
  constexpr std::size_t kSeconds = 8;
  constexpr std::size_t kMillis = 12;
  if (payload.size() < kLengthBytes) return {Extent::Kind::kNeedMore, 0, 0};
  const auto length = ReadAt<std::uint32_t>(payload, 0);
  if (length == kSeconds || length == kMillis) return Sized(kLengthBytes + length);
  if (payload.size() <= kSeconds) return {Extent::Kind::kNeedMore, 0, 0};
  return Sized(payload[kSeconds] == '.' ? kMillis : kSeconds);
}

Extent ExtentByType(std::string_view bytes, int type) {
  const auto items = static_cast<std::size_t>(ReadAt<std::uint8_t>(bytes, kItemCountAt));
  const auto rows = [items](std::size_t each, std::size_t short_each = 0) {
    return items > 0 ? Sized(items * each, items * short_each) : Extent();
  };
  switch (type) {
    case 1: return rows(28);
    case 3: return rows(16);
    case 2:
    case 5: return rows(32);
    case 20: return rows(20);
    case 21: return rows(40);
    case 22: return rows(44);
    case 23: return rows(68, 44);
    case 24: return Sized(36, 12);
    case 25: return ExtentOfTimeCode(bytes.substr(kHeaderBytes));
    case kTypeMetaData:
    case kTypeScale: return ExtentByWalk(bytes, type);
    default: return {};
  }
}

// Like FindIdString(), for types that MVN has or had: these occur by chance much less often.
std::size_t FindKnownIdString(std::string_view bytes, std::size_t from) {
  std::size_t position = FindIdString(bytes, from);
  while (position != std::string_view::npos &&
         !std::binary_search(kKnownTypes.begin(), kKnownTypes.end(),
                             TypeNumber(bytes.substr(position)))) {
    position = FindIdString(bytes, position + 1);
  }
  return position;
}

}  // namespace

Match MatchIdString(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, kMagic.size());
  if (start != kMagic.substr(0, start.size())) return Match::kNo;
  const std::string_view digits = bytes.substr(start.size(), kIdStringBytes - kMagic.size());
  if (!std::all_of(digits.begin(), digits.end(), IsDigit)) return Match::kNo;
  return bytes.size() >= kIdStringBytes ? Match::kYes : Match::kPartial;
}

int TypeNumber(std::string_view bytes) {
  return (bytes[kMagic.size()] - '0') * 10 + (bytes[kMagic.size() + 1] - '0');
}

std::size_t FindIdString(std::string_view bytes, std::size_t from) {
  std::size_t position = bytes.find(kMagic, from);
  while (position != std::string_view::npos &&
         MatchIdString(bytes.substr(position)) != Match::kYes) {
    position = bytes.find(kMagic, position + 1);
  }
  return position;
}

std::size_t SearchedIn(std::string_view bytes, std::size_t from) {
  constexpr std::size_t kOverlap = kIdStringBytes - 1;
  return std::max(from, bytes.size() - std::min(bytes.size(), kOverlap));
}

Extent ExtentOf(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return {Extent::Kind::kNeedMore, 0, 0};
  bytes = bytes.substr(0, kLargestExtent);
  const auto announced = ReadAt<std::uint16_t>(bytes, kPayloadSizeAt);
  return announced > 0 ? Sized(announced) : ExtentByType(bytes, TypeNumber(bytes));
}

std::optional<std::size_t> FindInnerDatagram(std::string_view bytes, std::size_t end,
                                             std::size_t& searched) {
  bytes = bytes.substr(0, end);
  InnerIdStrings inner(bytes, end);
  searched = std::max(searched, kIdStringBytes);
  while (true) {
    const std::size_t position = FindKnownIdString(bytes, searched);
    if (position == std::string_view::npos) {
      searched = SearchedIn(bytes, searched);
      return std::nullopt;
    }
    searched = position;
    switch (inner.Judge(position)) {
      case Inner::kDatagram: return position;
      case Inner::kNeedMore: return std::nullopt;
      case Inner::kText: searched = inner.text_end();
    }
  }
}

}  // namespace kinescope::mvn
