/// Builds ROS bags (format 2.0) record by record, also such that no recorder writes. Needs no ROS.
#pragma once

#include <archive.h>
#include <archive_entry.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/system/check.h"

namespace kinescope::fuzz {

inline std::string Little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>((value >> (8 * i)) & 0xFFU);
  return text;
}

using BagFields = std::vector<std::pair<std::string, std::string>>;

inline std::string FieldsOf(const BagFields& fields) {
  std::string text;
  for (const auto& [name, value] : fields) {
    text += Little(name.size() + 1 + value.size(), 4).append(name).append("=").append(value);
  }
  return text;
}

inline std::string BagRecord(int op, BagFields fields, const std::string& data) {
  fields.emplace_back("op", std::string(1, static_cast<char>(op)));
  const std::string header = FieldsOf(fields);
  return Little(header.size(), 4) + header + Little(data.size(), 4) + data;
}

inline std::string BagHeader(std::uint64_t index_at) {
  return "#ROSBAG V2.0\n" + BagRecord(3,
                                      {{"index_pos", Little(index_at, 8)},
                                       {"conn_count", Little(2, 4)},
                                       {"chunk_count", Little(1, 4)}},
                                      std::string(100, ' '));
}

inline std::string BagConnectionRecord(std::uint32_t number, const std::string& topic,
                                       const std::string& type) {
  return BagRecord(
      7, {{"conn", Little(number, 4)}, {"topic", topic}},
      FieldsOf({{"topic", topic}, {"type", type}, {"md5sum", "94810edda583a504dfda3829e70d7eec"}}));
}

inline std::string BagMessageRecord(std::uint32_t connection, std::uint32_t seconds,
                                    const std::string& data) {
  return BagRecord(2, {{"conn", Little(connection, 4)}, {"time", Little(seconds, 8)}}, data);
}

/// `compression`: none, bz2, lz4.
inline std::string BagPacked(const std::string& compression, const std::string& records) {
  if (compression == "none") return records;
  std::string packed(records.size() + 4096, '\0');
  std::size_t used = 0;
  archive* const packer = archive_write_new();
  archive_write_set_format_raw(packer);
  compression == "bz2" ? archive_write_add_filter_bzip2(packer)
                       : archive_write_add_filter_lz4(packer);
  archive_write_set_bytes_in_last_block(packer, 1);
  archive_entry* const entry = archive_entry_new();
  archive_entry_set_filetype(entry, AE_IFREG);
  const bool is_open =
      archive_write_open_memory(packer, packed.data(), packed.size(), &used) == ARCHIVE_OK;
  KINESCOPE_CHECK(is_open && archive_write_header(packer, entry) == ARCHIVE_OK);
  KINESCOPE_CHECK(archive_write_data(packer, records.data(), records.size()) ==
                  static_cast<la_ssize_t>(records.size()));
  KINESCOPE_CHECK(archive_write_close(packer) == ARCHIVE_OK);
  archive_entry_free(entry);
  archive_write_free(packer);
  packed.resize(used);
  return packed;
}

inline std::string BagChunk(const std::string& compression, const std::string& records) {
  return BagRecord(5, {{"compression", compression}, {"size", Little(records.size(), 4)}},
                   BagPacked(compression, records));
}

}  // namespace kinescope::fuzz
