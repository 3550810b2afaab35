/// Reads and writes the big-endian numbers of the MVN stream. The input is untrusted: a read past
/// the end returns false and leaves the position unchanged. One thread per object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace kinescope::mvn {

static_assert(sizeof(float) == 4, "the stream's floats are IEEE single precision");

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t offset() const { return offset_; }
  std::size_t remaining() const { return bytes_.size() - offset_; }

  [[nodiscard]] bool Seek(std::size_t offset) {
    if (offset > bytes_.size()) return false;
    offset_ = offset;
    return true;
  }

  /// Excludes everything from `end` on. @pre offset() <= end <= number of bytes
  void CutAt(std::size_t end) { bytes_ = bytes_.substr(0, end); }

  template <class Unsigned>
  [[nodiscard]] bool Read(Unsigned& value) {
    if (remaining() < sizeof(Unsigned)) return false;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
      bits = (bits << 8U) | static_cast<std::uint8_t>(bytes_[offset_ + i]);
    }
    offset_ += sizeof(Unsigned);
    value = static_cast<Unsigned>(bits);
    return true;
  }

  [[nodiscard]] bool ReadFloat(double& value) {
    std::uint32_t bits = 0;
    if (!Read(bits)) return false;
    float number = 0;
    std::memcpy(&number, &bits, sizeof number);
    value = number;
    return true;
  }

  /// The next `size` bytes, not copied.
  [[nodiscard]] bool ReadBytes(std::size_t size, std::string_view& value) {
    if (remaining() < size) return false;
    value = bytes_.substr(offset_, size);
    offset_ += size;
    return true;
  }

  /// All remaining bytes, not copied.
  [[nodiscard]] std::string_view ReadRest() {
    const std::string_view rest = bytes_.substr(offset_);
    offset_ = bytes_.size();
    return rest;
  }

 private:
  std::string_view bytes_;
  std::size_t offset_ = 0;
};

/// Appends numbers to a string that the caller may reuse.
class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  template <class Unsigned>
  void Write(Unsigned value) {
    for (int shift = 8 * (static_cast<int>(sizeof(Unsigned)) - 1); shift >= 0; shift -= 8) {
      out_.push_back(static_cast<char>((static_cast<std::uint32_t>(value) >> shift) & 0xFFU));
    }
  }

  void WriteFloat(double value) {
    const auto number = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    Write(bits);
  }

  /// A text as in the stream: signed length, then the bytes.
  void WriteText(std::string_view text) {
    Write(static_cast<std::uint32_t>(text.size()));
    out_.append(text);
  }

 private:
  std::string& out_;
};

}  // namespace kinescope::mvn
