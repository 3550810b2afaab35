/// Computes the SHA-256 of files and bytes (nettle), to compare their content. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace kinescope {

/// Of bytes that come in pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void Add(std::string_view bytes);
  /// 64 hexadecimal digits. Call it once, at the end.
  std::string Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct FileDigest {
  std::string sha256;  // 64 hexadecimal digits
  std::uint64_t bytes = 0;
};

/// Of the bytes in the file, compressed or not. @throws SourceError with the file and the reason.
FileDigest DigestOf(const std::filesystem::path& path);

}  // namespace kinescope
