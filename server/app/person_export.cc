#include "server/app/person_export.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

#include "render/new_file.h"
#include "server/core/errors.h"
#include "urdf/figure.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

std::string ReadWhole(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  if (!file || bytes.empty()) throw std::runtime_error(path.string() + " cannot be read");
  return bytes;
}

void WriteWhole(const fs::path& path, const std::string& bytes) {
  render::NewFile file(path);
  file.Write(bytes.data(), bytes.size());
  file.Commit();
}

std::string MeshOf(const urdf::HumanModel& human, int segment, const std::string& file_name) {
  if (human.mesh_folder.empty()) {
    return urdf::ToBinaryStl(urdf::SegmentMesh(human.skeleton, segment));
  }
  return ReadWhole(fs::path(human.mesh_folder) / file_name);
}

void Write(urdf::HumanModel human, const fs::path& folder, const std::string& package) {
  const fs::path meshes = folder / "meshes";
  fs::create_directories(meshes);
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const std::string name = std::string(urdf::kSegments[urdf::At(i)].link_name) + ".stl";
    WriteWhole(meshes / name, MeshOf(human, i, name));
  }
  human.mesh_folder =
      package.empty() ? fs::canonical(meshes).string() : "package://" + package + "/meshes";
  WriteWhole(folder / "person.urdf", urdf::WriteUrdf(human));
}

}  // namespace

void ExportPerson(const urdf::HumanModel& human, const fs::path& folder,
                  const std::string& package) {
  static const std::regex kPackageName("[A-Za-z][A-Za-z0-9_-]*");
  if (!package.empty() && !std::regex_match(package, kPackageName)) {
    throw UsageError(fmt::format(
        "--package={}: expected the name of a ROS package: a letter, then letters, digits, _ and -",
        package));
  }
  try {
    Write(human, folder, package);
  } catch (const std::runtime_error& error) {  // std::filesystem's errors too
    throw UsageError(fmt::format("--out={}: {}", folder.string(), error.what()));
  }
}

}  // namespace kinescope::app
