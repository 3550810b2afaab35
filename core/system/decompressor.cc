#include "core/system/decompressor.h"

#include <archive.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace kinescope {

struct Decompressor::Archive {
  Archive() : handle(archive_read_new()) {}
  ~Archive() { archive_read_free(handle); }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  archive* const handle;  // null: not enough memory
};

Decompressor::Decompressor(Input input, Format format)
    : input_(std::move(input)), archive_(std::make_unique<Archive>()), format_(format) {
  if (archive_->handle == nullptr) failure_ = "not enough memory to decompress it";
}

Decompressor::~Decompressor() = default;

void Decompressor::Open(Format format) {
  archive* const handle = archive_->handle;
  archive_read_support_format_raw(handle);
  archive_read_support_format_empty(handle);
  int status = ARCHIVE_OK;
  switch (format) {
    case Format::kAny:
      // Not "all": some filters start other programs.
      archive_read_support_filter_gzip(handle);
      archive_read_support_filter_bzip2(handle);
      archive_read_support_filter_xz(handle);
      archive_read_support_filter_zstd(handle);
      archive_read_support_filter_lz4(handle);
      break;
    case Format::kBzip2: archive_read_support_filter_bzip2(handle); break;
    case Format::kLz4: archive_read_support_filter_lz4(handle); break;
  }
  const auto read_input = [](archive* reader, void* self, const void** bytes) -> la_ssize_t {
    const ssize_t count = static_cast<Decompressor*>(self)->input_(bytes);
    if (count >= 0) return count;
    archive_set_error(reader, errno, "%s", std::strerror(errno));
    return ARCHIVE_FATAL;
  };
  archive_entry* entry = nullptr;
  status = archive_read_open(handle, this, nullptr, read_input, nullptr);
  if (status == ARCHIVE_OK) status = archive_read_next_header(handle, &entry);
  at_end_ = status == ARCHIVE_EOF;
  if (status < ARCHIVE_WARN) NoteFailure();
}

ssize_t Decompressor::Read(char* to, std::size_t size) {
  if (failure_.empty() && !std::exchange(is_open_, true)) Open(format_);
  if (!failure_.empty()) return -1;
  if (at_end_) return 0;
  la_ssize_t count = ARCHIVE_RETRY;
  while (count == ARCHIVE_RETRY) count = archive_read_data(archive_->handle, to, size);
  if (count >= 0) return count;
  NoteFailure();
  return -1;
}

void Decompressor::NoteFailure() {
  const char* const reason = archive_error_string(archive_->handle);
  failure_ = reason != nullptr ? reason : "the archive is damaged";
}

}  // namespace kinescope
