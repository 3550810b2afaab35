/// Computes the SHA-256 of files (nettle), to compare their content. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kinescope {

struct FileDigest {
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;
};

/// Of the bytes in the file, compressed or not. @throws SourceError with the file and the reason.
FileDigest DigestOf(const std::filesystem::path& path);

}  // namespace kinescope
