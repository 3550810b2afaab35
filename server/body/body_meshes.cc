#include "server/body/body_meshes.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>

#include "urdf/figure.h"
#include "urdf/hand_figure.h"
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

void WriteAll(const fs::path& folder, const std::vector<MeshFile>& meshes) {
  fs::create_directories(folder.parent_path());
  // Written aside and renamed: a reader, or a second process, sees all of it or nothing.
  const fs::path aside = folder.string() + fmt::format(".{}", getpid());
  fs::create_directory(aside);
  for (const MeshFile& mesh : meshes) {
    const fs::path path = aside / mesh.name;
    std::ofstream file(path, std::ios::binary);
    file << mesh.stl << std::flush;
    if (!file) throw std::runtime_error(path.string() + " cannot be written");
  }
  std::error_code already_there;
  fs::rename(aside, folder, already_there);
  if (already_there) fs::remove_all(aside);
}

}  // namespace

std::vector<MeshFile> BodyMeshFiles(const urdf::HumanModel& human, const CustomBodyMeshes* own) {
  std::vector<MeshFile> files;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const bool is_gloved = (i == urdf::kRightHand && human.gloves[urdf::kRight]) ||
                           (i == urdf::kLeftHand && human.gloves[urdf::kLeft]);
    if (is_gloved) continue;
    files.push_back({std::string(urdf::kSegments[urdf::At(i)].link_name) + ".stl",
                     urdf::ToBinaryStl(BodyMeshOf(own, human.skeleton, i))});
  }
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    for (int i = 0; human.gloves[side] && i < urdf::kFingersPerHand; ++i) {
      files.push_back({urdf::FingerFileName(side, i) + ".stl",
                       urdf::ToBinaryStl(urdf::FingerMesh(*human.gloves[side], i))});
    }
  }
  return files;
}

std::vector<MeshFile> ToolMeshFiles(const HandTools& tools, const urdf::Skeleton& skeleton) {
  std::vector<MeshFile> files;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (!tools[side]) continue;
    files.push_back({urdf::ToolFileName(side) + ".stl",
                     urdf::ToBinaryStl(ToHandFrame(*tools[side], skeleton, side))});
  }
  return files;
}

std::string WriteToCache(const std::vector<MeshFile>& files) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const MeshFile& file : files) hash = Hash(file.name + file.stl, hash);
  try {
    const fs::path folder = CacheFolder() / fmt::format("figure-{:016x}", hash);
    if (!fs::exists(folder)) WriteAll(folder, files);
    return folder.string();
  } catch (const std::exception& error) {
    static std::once_flag warned;  // builders on several threads may come here
    std::call_once(warned, [&] {
      spdlog::warn(
          "cannot write mesh files, so the body is drawn with primitives and without tools: {}",
          error.what());
    });
    return "";
  }
}

}  // namespace kinescope::app
