/// Headers of the records of a ROS 1 bag, format 2.0 (wiki.ros.org/Bags/Format/2.0): fields of name
/// and value, untrusted. Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::ros_bridge {

enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

inline constexpr std::size_t kLongestChunkHeader = 256;  // bytes; rosbag writes about 50

struct BagRecordHeader {
  BagOp op = {};
  std::optional<std::uint32_t> connection;
  std::optional<std::uint64_t> time;   // seconds, then nanoseconds
  std::optional<std::uint32_t> size;   // of a chunk, decompressed
  std::optional<std::uint32_t> count;  // of entries
  std::optional<std::uint64_t> index_at;
  std::string compression;
  std::string topic;
  bool is_encrypted = false;

  /// False if the fields are damaged, or the kind of the record is missing.
  [[nodiscard]] bool Parse(const std::vector<std::uint8_t>& bytes);
  /// Whether the record has as much data as its header says, as far as that says it.
  [[nodiscard]] bool Fits(std::uint32_t data_size) const;
  /// Whether it is the header of a chunk that can be read.
  [[nodiscard]] bool IsOfChunk() const;
};

/// Whether `text` begins with the record of a chunk.
[[nodiscard]] bool BeginsBagChunk(std::string_view text);

/// Little-endian, as this machine. @pre bytes.size() >= sizeof(Number)
template <class Number>
Number NumberIn(std::string_view bytes) {
  Number number = 0;
  std::memcpy(&number, bytes.data(), sizeof(number));
  return number;
}

/// Calls `take` with name and value of each field; false if the fields are damaged.
template <class Take>
[[nodiscard]] bool ForEachBagField(const std::vector<std::uint8_t>& bytes, const Take& take) {
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (!rest.empty()) {
    if (rest.size() < sizeof(std::uint32_t)) return false;
    const auto size = NumberIn<std::uint32_t>(rest);
    rest.remove_prefix(sizeof(size));
    if (size > rest.size()) return false;
    const std::string_view field = rest.substr(0, size);
    rest.remove_prefix(size);
    const std::size_t sign = field.find('=');
    if (sign == std::string_view::npos) return false;
    take(field.substr(0, sign), field.substr(sign + 1));
  }
  return true;
}

}  // namespace kinescope::ros_bridge
