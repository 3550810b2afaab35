#include "render/image/new_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace kinescope::render {
namespace {

std::filesystem::path FolderOf(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

// Unlike any other of this or another process.
std::filesystem::path HiddenName(const std::filesystem::path& target) {
  static std::atomic<unsigned> count{0};
  return FolderOf(target) / ("." + target.filename().string() + "." + std::to_string(::getpid()) +
                             "." + std::to_string(count++) + ".part");
}

}  // namespace

NewFile::NewFile(std::filesystem::path target) : target_(std::move(target)) {
  std::error_code ignored;
  if (target_.filename().empty() || std::filesystem::is_directory(target_, ignored)) {
    errno = EISDIR;
    Fail("cannot write");
  }
  if (std::filesystem::exists(target_, ignored) &&
      !std::filesystem::is_regular_file(target_, ignored)) {
    throw std::runtime_error("cannot write " + target_.string() + ": it is no regular file");
  }
  constexpr mode_t kMode = 0666;  // less the umask, as any new file
  descriptor_ = ::open(FolderOf(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
  if (descriptor_ >= 0) return;
  hidden_ = HiddenName(target_);
  descriptor_ = ::open(hidden_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode);
  if (descriptor_ < 0) {
    hidden_.clear();
    Fail("cannot write");
  }
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!hidden_.empty()) ::unlink(hidden_.c_str());
}

void NewFile::Fail(const std::string& what) const {
  throw std::runtime_error(what + " " + target_.string() + ": " + std::strerror(errno));
}

void NewFile::Write(const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) Fail("cannot write");
    from += written;
    size -= static_cast<std::size_t>(written);
  }
}

std::string NewFile::open_path() const {
  return hidden_.empty() ? "/proc/self/fd/" + std::to_string(descriptor_) : hidden_.string();
}

void NewFile::Commit() {
  if (hidden_.empty()) {
    const std::filesystem::path name = HiddenName(target_);
    // linkat() does not replace a file, rename() does.
    if (::linkat(AT_FDCWD, open_path().c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      Fail("cannot name");
    }
    hidden_ = name;
  }
  if (::rename(hidden_.c_str(), target_.c_str()) != 0) Fail("cannot replace");
  hidden_.clear();
  ::close(std::exchange(descriptor_, -1));
}

void WriteNewFile(const std::filesystem::path& path, std::string_view content) {
  NewFile file(path);
  file.Write(content.data(), content.size());
  file.Commit();
}

}  // namespace kinescope::render
