/// Decompresses a stream piece by piece, in constant memory. Formats: gzip, xz, zstd, bzip2, lz4.
/// One thread.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace kinescope {

class Decompressor {
 public:
  enum class Format { kAny, kBzip2, kLz4 };  // kAny: detected by the first bytes

  /// Provides the next compressed bytes, which stay valid until the next call: their number, 0 at
  /// the end, -1 with errno after a failure.
  using Input = std::function<ssize_t(const void** bytes)>;

  explicit Decompressor(Input input, Format format = Format::kAny);
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Writes at most `size` decompressed bytes: their number, 0 at the end, -1 after a failure,
  /// also in later calls.
  ssize_t Read(char* to, std::size_t size);

  /// Why Read() failed, such as "truncated gzip input"; "" without a failure.
  const std::string& failure() const { return failure_; }

 private:
  struct Archive;

  void Open(Format format);
  void NoteFailure();

  Input input_;
  std::unique_ptr<Archive> archive_;
  bool is_open_ = false;
  bool at_end_ = false;
  Format format_;
  std::string failure_;
};

}  // namespace kinescope
