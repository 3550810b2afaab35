#include "server/download/robot_meshes.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "core/system/scratch_folder.h"
#include "core/system/web_address.h"
#include "urdf/mesh_inputs.h"

namespace kinescope::download {
namespace {

namespace fs = std::filesystem;

// In the order of the model, each once.
std::vector<std::string> RemoteMeshesOf(const urdf::RobotModel& model) {
  std::vector<std::string> addresses;
  std::set<std::string> known;
  for (const urdf::Link& link : model.links) {
    for (const urdf::Visual& visual : link.visuals) {
      const std::string& uri = visual.geometry.mesh_uri;
      if (visual.geometry.kind != urdf::Geometry::Kind::kMesh || !IsWebAddress(uri)) continue;
      if (known.insert(uri).second) addresses.push_back(uri);
    }
  }
  return addresses;
}

// The reader of meshes goes by it. "": it is not one.
std::string ExtensionOf(const std::string& file_name) {
  constexpr std::size_t kLongest = 8;
  const std::string extension = fs::path(file_name).extension();
  const bool is_plain = extension.size() > 1 && extension.size() <= kLongest &&
                        std::all_of(extension.begin() + 1, extension.end(),
                                    [](unsigned char letter) { return std::isalnum(letter) != 0; });
  return is_plain ? extension : "";
}

// Of a file beside the mesh: no other folder.
bool IsPlainName(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\\') == std::string::npos;
}

std::string Beside(const std::string& address, const std::string& name) {
  const std::string path = address.substr(0, address.find_first_of("?#"));
  return path.substr(0, path.rfind('/') + 1) + name;
}

class RobotLoader {
 public:
  RobotLoader(const RobotMeshLimits& limits, const std::function<bool()>& is_stopped)
      : limits_(limits), loader_(limits.of_file, is_stopped) {}

  const std::shared_ptr<const ScratchFolder>& folder() const { return folder_; }

  std::variant<fs::path, urdf::MeshNotFound> Load(const std::string& address) {
    const auto refuse = [](const std::string& why) { return urdf::MeshNotFound{why}; };
    if (files_ >= limits_.most_files) return refuse("the robot has too many meshes on web servers");
    if (bytes_ >= limits_.most_bytes_of_all) {
      return refuse("the meshes of the robot are too large together");
    }
    const std::string extension = ExtensionOf(FileNameOf(address));
    if (extension.empty()) return refuse("expected the name of a file, such as arm.stl");
    const fs::path own = *folder_ / std::to_string(files_);  // materials of two may have one name
    std::error_code error;
    fs::create_directory(own, error);
    if (error) return refuse(own.string() + ": " + error.message());
    const fs::path mesh = own / ("mesh" + extension);
    if (const std::string problem = LoadInto(address, mesh); !problem.empty()) {
      return refuse(problem);
    }
    LoadMaterials(address, mesh);
    return mesh;
  }

 private:
  std::string LoadInto(const std::string& address, const fs::path& file) {
    const std::string server = ServerOf(address);
    const auto dead = dead_servers_.find(server);
    if (dead != dead_servers_.end()) return dead->second;
    ++files_;
    const WebLoader::Outcome outcome = loader_.Load(address, file);
    bytes_ += outcome.bytes;
    if (outcome.is_of_server) dead_servers_.emplace(server, outcome.problem);
    return outcome.problem;
  }

  // Without one the mesh has no colours, as a file without it has.
  void LoadMaterials(const std::string& address, const fs::path& mesh) {
    for (const std::string& name : urdf::MaterialNamesOf(mesh)) {
      if (!IsPlainName(name) || files_ >= limits_.most_files) continue;
      static_cast<void>(LoadInto(Beside(address, name), mesh.parent_path() / name));
    }
  }

  const RobotMeshLimits limits_;
  WebLoader loader_;
  const std::shared_ptr<const ScratchFolder> folder_ = std::make_shared<const ScratchFolder>();
  std::map<std::string, std::string> dead_servers_;  // and why
  std::size_t files_ = 0, bytes_ = 0;
};

}  // namespace

std::size_t CountRemoteMeshes(const urdf::RobotModel& model) {
  return RemoteMeshesOf(model).size();
}

void LoadRemoteMeshes(const urdf::RobotModel& model, urdf::MeshSearch& search,
                      const std::function<bool()>& is_stopped, const RobotMeshLimits& limits) {
  const std::vector<std::string> addresses = RemoteMeshesOf(model);
  if (addresses.empty()) return;
  RobotLoader loader(limits, is_stopped);
  for (const std::string& address : addresses) search.loaded[address] = loader.Load(address);
  search.folder_of_loaded = loader.folder();
}

}  // namespace kinescope::download
