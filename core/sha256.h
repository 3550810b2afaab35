/// SHA-256 of files (nettle): tells whether two files have the same content.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kinescope {

struct FileDigest {
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;
};

/// Of the file as it lies there, packed or not. @throws SourceError naming it and the reason.
FileDigest DigestOf(const std::filesystem::path& path);

}  // namespace kinescope
