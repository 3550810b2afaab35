#include "urdf/mesh_inputs.h"

#include <cstddef>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace kinescope::urdf {

std::vector<std::string> MaterialNamesOf(const std::filesystem::path& mesh) {
  constexpr std::size_t kMaxBytes = 64u << 20;  // as a mesh may have
  constexpr std::size_t kMaxNames = 64;
  std::vector<std::string> names;
  const std::string extension = mesh.extension();
  if (extension != ".obj" && extension != ".OBJ") return names;
  const std::string keyword = "mtllib ";
  std::ifstream lines(mesh);
  std::size_t read = 0;
  for (std::string line; read < kMaxBytes && std::getline(lines, line); read += line.size() + 1) {
    if (line.compare(0, keyword.size(), keyword) != 0) continue;
    std::string name = line.substr(keyword.size());
    while (!name.empty() && (name.back() == '\r' || name.back() == ' ')) name.pop_back();
    names.push_back(std::move(name));
    if (names.size() == kMaxNames) break;
  }
  return names;
}

std::vector<std::filesystem::path> FilesOfMesh(const std::filesystem::path& mesh) {
  std::vector<std::filesystem::path> files = {mesh};
  for (const std::string& name : MaterialNamesOf(mesh)) {
    const std::filesystem::path material = mesh.parent_path() / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(material, ignored)) files.push_back(material);
  }
  return files;
}

}  // namespace kinescope::urdf
