#include "server/app/person_export.h"

#include <fmt/format.h>

#include <regex>
#include <stdexcept>

#include "render/new_file.h"
#include "server/core/errors.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

void WriteWhole(const fs::path& path, const std::string& bytes) {
  render::NewFile file(path);
  file.Write(bytes.data(), bytes.size());
  file.Commit();
}

void Write(urdf::HumanModel& human, const std::vector<FigureFile>& files, const fs::path& folder,
           const std::string& package) {
  const fs::path meshes = folder / "meshes";
  fs::create_directories(files.empty() ? folder : meshes);
  for (const FigureFile& file : files) WriteWhole(meshes / file.name, file.stl);
  human.mesh_folder.clear();
  if (!files.empty()) {
    human.mesh_folder =
        package.empty() ? fs::canonical(meshes).string() : "package://" + package + "/meshes";
  }
  WriteWhole(folder / "person.urdf", urdf::WriteUrdf(human));
}

}  // namespace

void ExportPerson(urdf::HumanModel human, const std::vector<FigureFile>& meshes,
                  const fs::path& folder, const std::string& package) {
  static const std::regex kPackageName("[A-Za-z][A-Za-z0-9_-]*");
  if (!package.empty() && !std::regex_match(package, kPackageName)) {
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
