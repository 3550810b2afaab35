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

#include "core/system/scratch_folder.h"
#include "core/system/starts_with.h"
#include "server/body/mesh_memory.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr char kLockName[] = "lock";     // in each folder; its time is that of the last use
constexpr char kUnfinished[] = ".new-";  // in the names of folders that are being written
constexpr char kRemoved[] = ".old-";     // in the names of folders that are being removed

// A name that neither another thread nor another process uses: `infix` follows the folder's name.
fs::path UniqueName(const fs::path& folder, const char* infix) {
  static std::atomic<unsigned> count{0};
  return folder.string() + fmt::format("{}{}-{}", infix, getpid(), ++count);
}

// A path below a file: it cannot be created.
constexpr char kNowhere[] = "/dev/null/kinescope";

// An absolute path in the environment; empty without one.
fs::path FolderInEnvironment(const char* name) {
  const char* const text = std::getenv(name);
  return text != nullptr && text[0] == '/' ? fs::path(text) : fs::path();
}

std::vector<fs::path> LastingFolders() {
  std::vector<fs::path> folders;
  const std::string of_service = FolderInEnvironment("CACHE_DIRECTORY").string();
  if (!of_service.empty()) folders.push_back(of_service.substr(0, of_service.find(':')));
  if (const fs::path cache = FolderInEnvironment("XDG_CACHE_HOME"); !cache.empty()) {
    folders.push_back(cache / "kinescope");
  } else if (const fs::path home = FolderInEnvironment("HOME"); !home.empty()) {
    folders.push_back(home / ".cache/kinescope");
  }
  return folders;
}

int MakeFolders(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return 0;
  if (errno != ENOENT || !folder.has_relative_path()) return errno;
  const int error = MakeFolders(folder.parent_path());
  if (error != 0) return error;
  return ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST ? 0 : errno;
}

// Why `folder`, which is created, may contain files of other users; "" if it cannot.
// `forbidden`: permissions that it must not give.
std::string WhyUnfit(const fs::path& folder, mode_t forbidden) {
  const int error = MakeFolders(folder);
  if (error != 0) return std::generic_category().message(error);
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0) return std::generic_category().message(errno);
  if (!S_ISDIR(status.st_mode)) return std::generic_category().message(ENOTDIR);
  if (status.st_uid != ::geteuid()) return "it belongs to another user";
  if ((status.st_mode & forbidden) != 0) return "other users may write to it";
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return std::generic_category().message(errno);
  return "";
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
      : descriptor_(
            ::open((folder / kLockName).c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0600)) {}
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

// nullopt if another thread or process has renamed or removed it.
std::optional<CachedFolder> Inspect(const fs::path& path) {
  std::error_code gone;
  CachedFolder folder{path, fs::last_write_time(path / kLockName, gone)};
  if (gone) folder.last_use = fs::last_write_time(path, gone);
  if (gone) return std::nullopt;
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
  const fs::path removed = UniqueName(folder, kRemoved);
  std::error_code gone;
  fs::rename(folder, removed, gone);
  if (!gone) fs::remove_all(removed, gone);
}

}  // namespace

// What the sets of a cache share.
class MeshCache::Store {
 public:
  Store(fs::path root, std::uintmax_t limit, std::size_t max_sets)
      : root_(std::move(root)), limit_(limit), max_sets_(max_sets) {}

  /// In a folder that is removed with the store.
  explicit Store(std::unique_ptr<const ScratchFolder> scratch)
      : scratch_(std::move(scratch)), root_(scratch_->path()) {}

  const fs::path& root() const { return root_; }

  MeshMemory& memory() const { return memory_; }

  // Writes the files under another name; nullopt if the folder exists by then.
  std::optional<FolderLock> Write(const fs::path& folder, const std::vector<MeshFile>& files) const;
  void RemoveOldest() const;
  void WarnOnce(const std::string& reason) const {
    if (!has_warned_.exchange(true)) spdlog::warn("cannot write mesh files: {}", reason);
  }

 private:
  const std::unique_ptr<const ScratchFolder> scratch_;
  const fs::path root_;
  const std::uintmax_t limit_ = kDefaultLimit;
  const std::size_t max_sets_ = kDefaultSets;
  mutable std::atomic<bool> has_warned_{false};
  mutable MeshMemory memory_;
};

std::optional<FolderLock> MeshCache::Store::Write(const fs::path& folder,
                                                  const std::vector<MeshFile>& files) const {
  fs::create_directories(root_);  // the user may have removed it
  fs::path aside = UniqueName(folder, kUnfinished);
  while (!fs::create_directory(aside)) aside = UniqueName(folder, kUnfinished);  // left by a crash
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
    const std::optional<CachedFolder> inspected = Inspect(entry->path());
    if (!inspected) continue;
    folders.push_back(*inspected);
    bytes += inspected->bytes;
  }
  std::sort(folders.begin(), folders.end(), [](const CachedFolder& a, const CachedFolder& b) {
    return std::tie(a.last_use, a.path) < std::tie(b.last_use, b.path);
  });
  std::size_t sets = folders.size();
  for (const CachedFolder& folder : folders) {
    if (bytes <= limit_ && sets <= max_sets_) return;
    if (MayBeWritten(folder)) continue;
    RemoveUnlessUsed(folder.path);
    if (fs::exists(folder.path, error)) continue;
    bytes -= folder.bytes;
    --sets;
  }
}

class MeshCache::Set : public MeshFiles {
 public:
  Set(std::shared_ptr<const Store> store, fs::path folder,
      std::function<std::vector<MeshFile>()> make)
      : store_(std::move(store)), folder_(std::move(folder)), make_(std::move(make)) {}

  std::shared_ptr<const std::string> Content(const std::string& name) const override;
  bool Provide() const override;

 private:
  bool Open() const;

  const std::shared_ptr<const Store> store_;
  const fs::path folder_;
  const std::function<std::vector<MeshFile>()> make_;
  mutable std::mutex mutex_;
  mutable std::optional<FolderLock> in_use_;  // guarded by mutex_
};

std::shared_ptr<const std::string> MeshCache::Set::Content(const std::string& name) const {
  const auto files = store_->memory().Get(folder_.filename().string(), make_);
  if (!files) return nullptr;
  for (const MeshFile& mesh : *files) {
    if (mesh.name == name) return {files, &mesh.stl};  // keeps the others, too
  }
  return nullptr;
}

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

MeshCache::MeshCache(fs::path root, std::uintmax_t limit, std::size_t sets)
    : store_(std::make_shared<const Store>(std::move(root), limit, sets)) {}

MeshCache::MeshCache(std::shared_ptr<const Store> store) : store_(std::move(store)) {}

std::shared_ptr<const MeshCache> MeshCache::InMemory() {
  return std::make_shared<const MeshCache>(kNowhere);
}

std::shared_ptr<const MeshCache> MeshCache::OfUser(Lifetime lifetime) {
  std::string why = "neither XDG_CACHE_HOME nor HOME is set";
  for (const fs::path& folder : LastingFolders()) {
    const std::string fault = WhyUnfit(folder, S_IWOTH);
    if (fault.empty()) return std::make_shared<const MeshCache>(folder);
    why = folder.string() + ": " + fault;
  }
  if (lifetime == Lifetime::kProcess) {
    const fs::path runtime = FolderInEnvironment("XDG_RUNTIME_DIR");
    if (!runtime.empty() && WhyUnfit(runtime, 0077).empty()) {
      const fs::path folder = runtime / "kinescope";
      if (WhyUnfit(folder, 0077).empty()) return std::make_shared<const MeshCache>(folder);
    }
    try {
      auto scratch = std::make_unique<const ScratchFolder>();
      return std::shared_ptr<const MeshCache>(
          new MeshCache(std::make_shared<const Store>(std::move(scratch))));
    } catch (const std::exception& error) {
      why += std::string("; ") + error.what();
    }
  }
  spdlog::warn(
      "cannot write mesh files, so the body is drawn with primitives and without tools: {}", why);
  return nullptr;
}

fs::path MeshCache::FolderOf(const std::string& name) const { return store_->root() / name; }

std::shared_ptr<const MeshFiles> MeshCache::Files(
    const std::string& name, std::function<std::vector<MeshFile>()> make) const {
  return std::make_shared<const Set>(store_, FolderOf(name), std::move(make));
}

}  // namespace kinescope::app
