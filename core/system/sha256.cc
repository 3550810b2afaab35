#include "core/system/sha256.h"

#include <nettle/sha2.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/system/errors.h"

namespace kinescope {

FileDigest DigestOf(const std::filesystem::path& path) {
  const auto fail = [&] {
    throw SourceError("cannot read " + path.string() + ": " + std::strerror(errno));
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rbe"));
  if (!file) fail();
  sha256_ctx state;
  sha256_init(&state);
  FileDigest digest;
  std::vector<std::uint8_t> block(1u << 16);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), file.get())) {
    sha256_update(&state, size, block.data());
    digest.bytes += size;
  }
  if (std::ferror(file.get()) != 0) fail();  // a folder opens, but cannot be read
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> hash{};
  sha256_digest(&state, hash.size(), hash.data());
  for (const std::uint8_t byte : hash) {
    constexpr char kDigits[] = "0123456789abcdef";
    digest.sha256 += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return digest;
}

}  // namespace kinescope
