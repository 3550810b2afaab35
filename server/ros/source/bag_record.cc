#include "server/ros/source/bag_record.h"

#include <algorithm>

namespace kinescope::ros_bridge {
namespace {

template <class Number>
std::optional<Number> BagFieldOf(std::string_view value) {
  if (value.size() != sizeof(Number)) return std::nullopt;
  return NumberIn<Number>(value);
}

}  // namespace

bool BagRecordHeader::Parse(const std::vector<std::uint8_t>& bytes) {
  bool has_op = false;
  const bool is_sound = ForEachBagField(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "op" && value.size() == 1) {
      op = static_cast<BagOp>(value[0]);
      has_op = true;
    }
    if (name == "conn") connection = BagFieldOf<std::uint32_t>(value);
    if (name == "time") time = BagFieldOf<std::uint64_t>(value);
    if (name == "size") size = BagFieldOf<std::uint32_t>(value);
    if (name == "count") count = BagFieldOf<std::uint32_t>(value);
    if (name == "index_pos") index_at = BagFieldOf<std::uint64_t>(value);
    if (name == "compression") compression = value;
    if (name == "topic") topic = value;
    if (name == "encryptor") is_encrypted = !value.empty();
  });
  return is_sound && has_op;
}

bool BagRecordHeader::Fits(std::uint32_t data_size) const {
  constexpr std::uint64_t kIndexEntry = 12, kChunkInfoEntry = 8;  // bytes
  if (!count) return true;
  if (op == BagOp::kIndexData) return data_size == *count * kIndexEntry;
  return op != BagOp::kChunkInfo || data_size == *count * kChunkInfoEntry;
}

bool BagRecordHeader::IsOfChunk() const {
  return op == BagOp::kChunk && size &&
         (compression == "none" || compression == "bz2" || compression == "lz4");
}

bool BeginsBagChunk(std::string_view text) {
  if (text.size() < sizeof(std::uint32_t)) return false;
  const auto size = NumberIn<std::uint32_t>(text);
  if (size > std::min(text.size() - sizeof(size), kLongestChunkHeader)) return false;
  BagRecordHeader header;
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(text.data()) + sizeof(size);
  return header.Parse({begin, begin + size}) && header.IsOfChunk();
}

}  // namespace kinescope::ros_bridge
