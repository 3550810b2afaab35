#include "server/app/urdf/person_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "core/system/errors.h"
#include "render/image/new_file.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// @return how a URDF names where they are, "" for none.
std::string WriteMeshes(const std::vector<MeshFile>& files, const fs::path& folder,
                        const std::string& package) {
  if (files.empty()) return "";
  fs::create_directories(folder);
  for (const MeshFile& file : files) render::WriteNewFile(folder / file.name, file.stl);
  return package.empty() ? fs::canonical(folder).string() : "package://" + package + "/meshes";
}

void Write(urdf::HumanModel& human, const PersonFiles& files, const fs::path& folder,
           const std::string& package) {
  fs::create_directories(folder);
  human.mesh_folder = WriteMeshes(files.body, folder / "meshes", package);
  human.tool_folder = WriteMeshes(files.tools, folder / "meshes", package);
  render::WriteNewFile(folder / "person.urdf", urdf::WriteUrdf(human));
}

// A letter of ASCII, then letters, digits, _ and -.
bool IsPackageName(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
         });
}

}  // namespace

void ExportPerson(urdf::HumanModel human, const PersonFiles& meshes, const fs::path& folder,
                  const std::string& package) {
  if (!package.empty() && !IsPackageName(package)) {
    throw UsageError(fmt::format(
        "--package={}: expected the name of a ROS package: a letter, then letters, digits, _ and -",
        package));
  }
  try {
    Write(human, meshes, folder, package);
  } catch (const std::runtime_error& error) {  // std::filesystem's errors too
    throw UsageError(fmt::format("--out={}: {}", folder.string(), error.what()));
  }
}

}  // namespace kinescope::app
