#include "server/body/mesh_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/system/starts_with.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr char kLockName[] = "lock";     // in each folder; its time is that of the last use
constexpr char kUnfinished[] = ".new-";  // in the names of folders that are being written

fs::path UserCacheFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') {
    return fs::path(cache) / "kinescope";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
    return fs::path(home) / ".cache/kinescope";
  }
  return fs::temp_directory_path() / fmt::format("kinescope-{}", getuid());
}

[[noreturn]] void FailToWrite(const fs::path& path) {
  throw std::runtime_error(
      fmt::format("{}: {}", path.string(), std::generic_category().message(errno)));
}

// An open lock file of a folder. The lock belongs to it, and ends with it.
class FolderLock {
 public:
  // `flags`: O_CREAT, where the folder may have none.
  explicit FolderLock(const fs::path& folder, int flags = 0)
      : descriptor_(::open((folder / kLockName).c_str(), O_RDWR | O_CLOEXEC | flags, 0666)) {}
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  // Waits while the folder is being removed.
  void Share() const {
    while (::flock(descriptor_, LOCK_SH) != 0 && errno == EINTR) {
    }
  }
  // False while a folder is in use.
  bool Own() const { return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }
  // False after the folder was removed, also if there is another one of its name.
  bool IsOf(const fs::path& folder) const {
    struct stat here {
    }, there{};
    return ::fstat(descriptor_, &here) == 0 && ::stat((folder / kLockName).c_str(), &there) == 0 &&
           here.st_dev == there.st_dev && here.st_ino == there.st_ino;
  }
  void Touch() const { ::futimens(descriptor_, nullptr); }

 private:
  int descriptor_;
};

struct CachedFolder {
  fs::path path;
  fs::file_time_type last_use;
  std::uintmax_t bytes = 0;
};

// Everything is read without exceptions: another process may be removing it.
CachedFolder Inspect(const fs::path& path) {
  std::error_code gone;
  CachedFolder folder{path, fs::last_write_time(path / kLockName, gone)};
  if (gone) folder.last_use = fs::last_write_time(path, gone);
  for (fs::directory_iterator file(path, gone), end; !gone && file != end; file.increment(gone)) {
    std::error_code no_size;
    const std::uintmax_t bytes = file->file_size(no_size);
    if (!no_size) folder.bytes += bytes;
  }
  return folder;
}

bool MayBeWritten(const CachedFolder& folder) {
  constexpr std::chrono::hours kLongest(1);
  const bool is_unfinished = folder.path.filename().string().find(kUnfinished) != std::string::npos;
  return is_unfinished && fs::file_time_type::clock::now() - folder.last_use < kLongest;
}

void RemoveUnlessUsed(const fs::path& folder) {
  const FolderLock lock(folder);
  if (lock.is_open() && !(lock.Own() && lock.IsOf(folder))) return;
  // Renamed first: a reader sees all files or none.
  const fs::path removed = folder.string() + fmt::format(".old-{}", getpid());
  std::error_code ignored;
  fs::rename(folder, removed, ignored);
  fs::remove_all(ignored ? folder : removed, ignored);
}

}  // namespace

// What the sets of a cache share.
class MeshCache::Store {
 public:
  Store(fs::path root, std::uintmax_t limit) : root_(std::move(root)), limit_(limit) {}

  const fs::path& root() const { return root_; }

  // Writes the files under another name; nullopt if the folder exists by then.
  std::optional<FolderLock> Write(const fs::path& folder, const std::vector<MeshFile>& files) const;
  void RemoveOldest() const;
  void WarnOnce(const std::string& reason) const {
    if (!has_warned_.exchange(true)) spdlog::warn("cannot write mesh files: {}", reason);
  }

 private:
  const fs::path root_;
  const std::uintmax_t limit_;
  mutable std::atomic<bool> has_warned_{false};
};

std::optional<FolderLock> MeshCache::Store::Write(const fs::path& folder,
                                                  const std::vector<MeshFile>& files) const {
  fs::create_directories(root_);  // the user may have removed it
  fs::path aside;
  for (int i = 0; aside.empty() || !fs::create_directory(aside); ++i) {
    aside = folder.string() + fmt::format("{}{}-{}", kUnfinished, getpid(), i);
  }
  try {
    FolderLock lock(aside, O_CREAT);
    if (!lock.is_open()) FailToWrite(aside);
    lock.Share();
    for (const MeshFile& mesh : files) {
      std::ofstream file(aside / mesh.name, std::ios::binary);
      file << mesh.stl << std::flush;
      if (!file) FailToWrite(aside / mesh.name);
    }
    std::error_code error;
    fs::rename(aside, folder, error);
    if (!error) return lock;
    const bool exists = error == std::errc::directory_not_empty || error == std::errc::file_exists;
    if (!exists) throw fs::filesystem_error("cannot rename", aside, folder, error);
    fs::remove_all(aside);
    return std::nullopt;
  } catch (const std::exception&) {
    std::error_code ignored;
    fs::remove_all(aside, ignored);
    throw;
  }
}

void MeshCache::Store::RemoveOldest() const {
  std::vector<CachedFolder> folders;
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator entry(root_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    // "figure-": of earlier versions.
    if (!StartsWith(name, "body-") && !StartsWith(name, "figure-")) continue;
    folders.push_back(Inspect(entry->path()));
    bytes += folders.back().bytes;
  }
  std::sort(folders.begin(), folders.end(), [](const CachedFolder& a, const CachedFolder& b) {
    return std::tie(a.last_use, a.path) < std::tie(b.last_use, b.path);
  });
  for (const CachedFolder& folder : folders) {
    if (bytes <= limit_) return;
    if (MayBeWritten(folder)) continue;
    RemoveUnlessUsed(folder.path);
    if (!fs::exists(folder.path, error)) bytes -= folder.bytes;
  }
}

class MeshCache::Set : public MeshFiles {
 public:
  Set(std::shared_ptr<const Store> store, fs::path folder,
      std::function<std::vector<MeshFile>()> make)
      : store_(std::move(store)), folder_(std::move(folder)), make_(std::move(make)) {}

  bool Provide() const override;

 private:
  bool Open() const;

  const std::shared_ptr<const Store> store_;
  const fs::path folder_;
  const std::function<std::vector<MeshFile>()> make_;
  mutable std::mutex mutex_;
  mutable std::optional<FolderLock> in_use_;  // guarded by mutex_
};

// Takes the files that exist into use.
bool MeshCache::Set::Open() const {
  FolderLock lock(folder_, O_CREAT);
  if (!lock.is_open()) return false;
  lock.Share();
  if (!lock.IsOf(folder_)) return false;
  lock.Touch();
  in_use_.emplace(std::move(lock));
  return true;
}

bool MeshCache::Set::Provide() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (in_use_ && in_use_->IsOf(folder_)) return true;
  in_use_.reset();
  try {
    constexpr int kAttempts = 10;  // another process may write or remove the set in between
    for (int i = 0; i < kAttempts; ++i) {
      if (Open()) return true;
      std::optional<FolderLock> written = store_->Write(folder_, make_());
      if (!written) continue;
      in_use_.emplace(*std::move(written));
      store_->RemoveOldest();
      return true;
    }
    store_->WarnOnce(folder_.string() + ": another process removes it");
  } catch (const std::exception& error) {
    store_->WarnOnce(error.what());
  }
  return false;
}

MeshCache::MeshCache(fs::path root, std::uintmax_t limit)
    : store_(std::make_shared<const Store>(std::move(root), limit)) {}

std::shared_ptr<const MeshCache> MeshCache::OfUser() {
  const fs::path root = UserCacheFolder();
  std::error_code error;
  fs::create_directories(root, error);
  if (!error && ::access(root.c_str(), W_OK | X_OK) != 0) error = {errno, std::generic_category()};
  if (!error && !fs::is_directory(root)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error) return std::make_shared<const MeshCache>(root);
  spdlog::warn(
      "cannot write mesh files, so the body is drawn with primitives and without tools: {}: {}",
      root.string(), error.message());
  return nullptr;
}

fs::path MeshCache::FolderOf(const std::string& name) const { return store_->root() / name; }

std::shared_ptr<const MeshFiles> MeshCache::Files(
    const std::string& name, std::function<std::vector<MeshFile>()> make) const {
  return std::make_shared<const Set>(store_, FolderOf(name), std::move(make));
}

}  // namespace kinescope::app
