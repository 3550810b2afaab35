#include "render/shader_cache.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <system_error>

namespace kinescope::render {
namespace {

namespace fs = std::filesystem;

// The index of Mesa's disk_cache.c, since 2017: a size and 2^16 keys of 20 bytes.
constexpr off_t kIndexBytes = 8 + (1 << 16) * 20;
// Where allocated blocks are copied when they are written (btrfs, ZFS), reserving them is not
// enough. And a cache that could not grow is worth nothing.
constexpr std::uintmax_t kMinFreeBytes = 4 << 20;

std::string EnvironmentText(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path HomeOfAccount() {
  std::array<char, 4096> memory{};
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwuid_r(::getuid(), &entry, memory.data(), memory.size(), &found) != 0) return {};
  return found == nullptr || found->pw_dir == nullptr ? fs::path() : fs::path(found->pw_dir);
}

// As Mesa reads it.
bool IsSwitchedOff(const char* name) {
  const std::string value = EnvironmentText(name);
  return value == "1" || value == "true" || value == "True" || value == "TRUE" || value == "yes" ||
         value == "y" || value == "Y";
}

void UseCacheFolderOfService() {
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"}) {
    if (!EnvironmentText(name).empty()) return;
  }
  // Several folders are separated by colons.
  const std::string folders = EnvironmentText("CACHE_DIRECTORY");
  const std::string folder = folders.substr(0, folders.find(':'));
  if (folder.empty() || folder.front() != '/') return;
  ::setenv("MESA_SHADER_CACHE_DIR", folder.c_str(), 1);
  ::setenv("MESA_GLSL_CACHE_DIR", folder.c_str(), 1);  // of Mesa before 22
}

bool IsOfFullDisk(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

// @return 0 or the number of the error.
int ReserveIndex(const fs::path& folder) {
  for (const fs::path& each : {folder.parent_path(), folder}) {
    if (::mkdir(each.c_str(), 0700) != 0 && errno != EEXIST) return errno;
  }
  const fs::path path = folder / "index";
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return errno;
  struct stat before {};
  const bool is_new = ::fstat(file, &before) == 0 && before.st_size == 0;
  int error = 0;
  do {
    error = ::posix_fallocate(file, 0, kIndexBytes);
  } while (error == EINTR);
  struct statvfs disk {};
  if (error == 0 && ::fstatvfs(file, &disk) == 0 &&
      static_cast<std::uintmax_t>(disk.f_bavail) * disk.f_frsize < kMinFreeBytes) {
    error = ENOSPC;
  }
  ::close(file);
  if (error != 0 && is_new) ::unlink(path.c_str());
  return error;
}

std::string PrepareOnce() {
  if (IsSwitchedOff("MESA_SHADER_CACHE_DISABLE") || IsSwitchedOff("MESA_GLSL_CACHE_DISABLE")) {
    return "";
  }
  UseCacheFolderOfService();
  const fs::path folder = ShaderCacheFolder();
  const int error = folder.empty() ? ENOENT : ReserveIndex(folder);
  if (error == 0) return "";
  ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  ::setenv("MESA_GLSL_CACHE_DISABLE", "true", 1);  // of Mesa before 22
  if (!IsOfFullDisk(error)) return "";             // as usual for a service without a home
  return "compiled shaders are not kept, so each start takes longer: " + folder.string() + ": " +
         std::generic_category().message(error);
}

}  // namespace

fs::path ShaderCacheFolder() {
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"}) {
    const std::string folder = EnvironmentText(name);
    if (!folder.empty()) return fs::path(folder) / "mesa_shader_cache";
  }
  const fs::path home = HomeOfAccount();
  return home.empty() ? fs::path() : home / ".cache/mesa_shader_cache";
}

std::string ReserveShaderIndex(const fs::path& folder) {
  const int error = ReserveIndex(folder);
  return error == 0 ? "" : std::generic_category().message(error);
}

std::string PrepareShaderCache() {
  static std::once_flag is_prepared;
  std::string line;
  std::call_once(is_prepared, [&line] { line = PrepareOnce(); });
  return line;
}

}  // namespace kinescope::render
