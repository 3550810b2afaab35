#include "server/recording/folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <system_error>
#include <utility>

#include "core/system/clocks.h"

namespace kinescope::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPart = 40;
constexpr std::size_t kLongestName = 160;
constexpr std::array<std::string_view, 6> kEndings = {".pcapng", ".pcap", ".mp4",
                                                      ".png",    ".html", ".json"};

bool IsPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

bool IsOurName(const std::string& name) {
  if (name.size() > kLongestName) return false;
  const std::size_t dot = name.find('.');
  if (dot == 0 || dot == std::string::npos) return false;
  const bool is_plain = std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(dot),
                                    [](char c) { return IsPlain(c); });
  return is_plain &&
         std::find(kEndings.begin(), kEndings.end(), name.substr(dot)) != kEndings.end();
}

std::optional<FileEntry> EntryOf(const fs::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  constexpr std::int64_t kMicros = 1'000'000;
  return FileEntry{path.filename().string(), static_cast<std::uintmax_t>(status.st_size),
                   status.st_mtim.tv_sec * kMicros + status.st_mtim.tv_nsec / 1000};
}

std::optional<std::uintmax_t> FreeBytesOf(const fs::path& path) {
  // Of a folder that is still to be made, those of the nearest one that is there.
  for (fs::path at = path; !at.empty(); at = at.parent_path()) {
    std::error_code error;
    const fs::space_info space = fs::space(at, error);
    if (!error) return space.available;
    if (at == at.parent_path()) break;
  }
  return std::nullopt;
}

}  // namespace

std::string NamePart(std::string_view text, std::string_view instead) {
  std::string part;
  for (const char c : text) {
    if (IsPlain(c)) {
      part += c;
    } else if (!part.empty() && part.back() != '_') {
      part += '_';
    }
    if (part.size() == kLongestPart) break;
  }
  while (!part.empty() && part.back() == '_') part.pop_back();
  return part.empty() ? std::string(instead) : part;
}

std::string TimeName() {
  const std::int64_t millis = WallNanos() / kNanosPerMilli;
  const auto secs = static_cast<std::time_t>(millis / 1000);
  std::tm parts{};
  ::gmtime_r(&secs, &parts);
  char name[32];
  std::strftime(name, sizeof name, "%Y%m%dT%H%M%S", &parts);
  char with_millis[48];
  std::snprintf(with_millis, sizeof with_millis, "%s-%03dZ", name, static_cast<int>(millis % 1000));
  return with_millis;
}

Folder::Folder(fs::path path, bool may_make, FreeBytes free_bytes)
    : path_(std::move(path)),
      may_make_(may_make),
      free_bytes_(free_bytes ? std::move(free_bytes) : FreeBytes(FreeBytesOf)) {}

std::string Folder::Prepare() const {
  std::error_code error;
  if (may_make_) fs::create_directories(path_, error);
  const std::string name = "the folder of recordings, " + path_.string() + ", ";
  if (!fs::is_directory(path_, error)) {
    return name + "is missing; make it, or connect its disk (--recordings_folder)";
  }
  if (::access(path_.c_str(), W_OK | X_OK) != 0) {
    return name +
           "cannot be written to; change its permissions, or choose another one with "
           "--recordings_folder";
  }
  return "";
}

std::string Folder::FreeStem(const std::string& stem) const {
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(kEndings.begin(), kEndings.end(), [&](std::string_view ending) {
      std::error_code ignored;
      return fs::exists(fs::symlink_status(path_ / (name + std::string(ending)), ignored));
    });
  };
  std::string free = stem;
  for (int number = 2; is_taken(free); ++number) free = stem + "-" + std::to_string(number);
  return free;
}

std::optional<fs::path> Folder::Find(const std::string& name) const {
  if (!IsOurName(name) || !EntryOf(path_ / name)) return std::nullopt;
  return path_ / name;
}

std::vector<FileEntry> Folder::List(std::size_t most) const {
  std::vector<FileEntry> files;
  std::error_code error;
  for (fs::directory_iterator each(path_, error), end; !error && each != end;
       each.increment(error)) {
    const std::string name = each->path().filename().string();
    if (!IsOurName(name)) continue;
    if (auto entry = EntryOf(each->path())) files.push_back(*std::move(entry));
  }
  std::sort(files.begin(), files.end(), [](const FileEntry& a, const FileEntry& b) {
    return std::make_pair(-a.modified_micros, a.name) < std::make_pair(-b.modified_micros, b.name);
  });
  if (files.size() > most) files.resize(most);
  return files;
}

}  // namespace kinescope::recording
