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

struct Sha256::State {
  sha256_ctx context;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { sha256_init(&state_->context); }
Sha256::~Sha256() = default;

void Sha256::Add(std::string_view bytes) {
  sha256_update(&state_->context, bytes.size(),
                reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

std::string Sha256::Finish() {
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> hash{};
  sha256_digest(&state_->context, hash.size(), hash.data());
  std::string digits;
  for (const std::uint8_t byte : hash) {
    constexpr char kDigits[] = "0123456789abcdef";
    digits += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return digits;
}

FileDigest DigestOf(const std::filesystem::path& path) {
  const auto fail = [&] {
    throw SourceError("cannot read " + path.string() + ": " + std::strerror(errno));
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rbe"));
  if (!file) fail();
  Sha256 hash;
  FileDigest digest;
  std::vector<char> block(1u << 16);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), file.get())) {
    hash.Add({block.data(), size});
    digest.bytes += size;
  }
  if (std::ferror(file.get()) != 0) fail();  // a folder opens, but cannot be read
  digest.sha256 = hash.Finish();
  return digest;
}

}  // namespace kinescope
