#include "server/app/figure_files.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "urdf/figure.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

fs::path CacheFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') {
    return fs::path(cache) / "kinescope";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
    return fs::path(home) / ".cache/kinescope";
  }
  return fs::temp_directory_path() / fmt::format("kinescope-{}", getuid());
}

// FNV-1a over the meshes themselves: another body, or another way of drawing one, is another
// folder.
std::uint64_t Hash(const std::string& bytes, std::uint64_t hash) {
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ULL;
  return hash;
}

void WriteAll(const fs::path& folder, const std::array<std::string, urdf::kSegmentCount>& meshes) {
  fs::create_directories(folder.parent_path());
  // Written aside and renamed: a reader, or a second process, sees all of it or nothing.
  const fs::path aside = folder.string() + fmt::format(".{}", getpid());
  fs::create_directory(aside);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const fs::path path = aside / (std::string(urdf::kSegments[i].link_name) + ".stl");
    std::ofstream file(path, std::ios::binary);
    file << meshes[i] << std::flush;
    if (!file) throw std::runtime_error(path.string() + " cannot be written");
  }
  std::error_code already_there;
  fs::rename(aside, folder, already_there);
  if (already_there) fs::remove_all(aside);
}

}  // namespace

std::string WriteFigureFiles(const urdf::Skeleton& skeleton, const FigureMeshes* own) {
  std::array<std::string, urdf::kSegmentCount> meshes;
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    std::string& mesh = meshes[static_cast<std::size_t>(i)];
    mesh = urdf::ToBinaryStl(FigureMeshOf(own, skeleton, i));
    hash = Hash(mesh, hash);
  }
  try {
    const fs::path folder = CacheFolder() / fmt::format("figure-{:016x}", hash);
    if (!fs::exists(folder)) WriteAll(folder, meshes);
    return folder.string();
  } catch (const std::exception& error) {
    static bool has_warned = false;
    if (!has_warned) spdlog::warn("the figure is drawn coarsely: {}", error.what());
    has_warned = true;
    return "";
  }
}

}  // namespace kinescope::app
