#include "server/app/batch/file_stamp.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/system/clocks.h"
#include "core/system/sha256.h"
#include "server/app/render/output_plan.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

void AddTo(FileStamp& stamp, const std::string& file) {
  struct stat found = {};
  if (::stat(file.c_str(), &found) != 0) return;
  ++stamp.files;
  stamp.bytes += found.st_size;
  stamp.modified_nanos = std::max(stamp.modified_nanos,
                                  found.st_mtim.tv_sec * kNanosPerSecond + found.st_mtim.tv_nsec);
}

std::vector<std::string> FilesIn(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> FilesOf(const DeclaredOutput& output) {
  std::error_code ignored;
  switch (output.kind) {
    case DeclaredOutput::Kind::kFolder: return FilesIn(output.path);
    case DeclaredOutput::Kind::kNumbered: {
      std::vector<std::string> files;
      for (long k = 0;; ++k) {
        std::string file = PathOfPicture(output.path, k);
        if (!fs::is_regular_file(file, ignored)) return files;
        files.push_back(std::move(file));
      }
    }
    case DeclaredOutput::Kind::kFile: break;
  }
  if (!fs::is_regular_file(output.path, ignored)) return {};
  return {output.path};
}

FileStamp StampOfFiles(const std::string& path, const std::vector<std::string>& files) {
  FileStamp stamp;
  stamp.path = path;
  for (const std::string& file : files) AddTo(stamp, file);
  return stamp;
}

}  // namespace

FileStamp StampOf(const std::string& path) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(path, ignored);
  return StampOfFiles(path, is_folder ? FilesIn(path) : std::vector<std::string>{path});
}

FileStamp StampOf(const DeclaredOutput& output) {
  return StampOfFiles(output.path, FilesOf(output));
}

std::string HashOf(const DeclaredOutput& output) {
  if (output.kind == DeclaredOutput::Kind::kFile) return DigestOf(output.path).sha256;
  Sha256 hash;
  for (const std::string& file : FilesOf(output)) {
    const std::string name = output.kind == DeclaredOutput::Kind::kFolder
                                 ? fs::path(file).lexically_relative(output.path).string()
                                 : fs::path(file).filename().string();
    hash.Add(DigestOf(file).sha256 + "  " + name + "\n");
  }
  return hash.Finish();
}

}  // namespace kinescope::app
