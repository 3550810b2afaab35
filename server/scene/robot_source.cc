#include "server/scene/robot_source.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <variant>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "server/download/robot_meshes.h"
#include "urdf/mesh_inputs.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::app {

namespace fs = std::filesystem;

std::string ReadUrdfFile(const fs::path& path) {
  const auto fail = [&](const std::string& why) {
    return SourceError("file '" + path.string() + "': " + why);
  };
  std::error_code error;
  if (fs::is_directory(path, error)) throw fail("is a folder; name the .urdf in it");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw fail(std::strerror(errno));
  const std::size_t most = urdf::XmlLimits().bytes + 1;  // what is too long is said so later
  std::string bytes;
  std::string part(1u << 16, '\0');
  while (bytes.size() < most && file) {
    file.read(part.data(),
              static_cast<std::streamsize>(std::min(part.size(), most - bytes.size())));
    bytes.append(part, 0, static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw fail("cannot read the file");
  return bytes;
}

namespace {

void CheckJoints(const urdf::JointPositions& positions, const urdf::RobotModel& model) {
  std::vector<std::string> known;
  known.reserve(model.joints.size());
  for (const urdf::RobotJoint& joint : model.joints) known.push_back(joint.name);
  for (const auto& [name, position] : positions) {
    if (std::count(known.begin(), known.end(), name) > 0) continue;
    throw urdf::UrdfError("unknown joint '" + name + "'" + SuggestionFor(name, known));
  }
}

}  // namespace

urdf::MeshSearch SearchFor(const urdf::RobotModel& model, const fs::path& path,
                           const std::vector<std::string>& package_path) {
  urdf::MeshSearch search = urdf::MakeMeshSearch(path, package_path);
  const std::size_t remote = download::CountRemoteMeshes(model);
  if (remote > 0)
    spdlog::info("{}: loads {} from web servers", path.string(), Counted(remote, "mesh", "meshes"));
  download::LoadRemoteMeshes(model, search, StopRequested);
  return search;
}

RobotState ReadRobot(const fs::path& path, const std::vector<std::string>& package_path,
                     const urdf::JointPositions& joints) {
  RobotState robot;
  try {
    robot.model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(ReadUrdfFile(path)));
    CheckJoints(joints, *robot.model);
    robot.world_from_link = urdf::PlaceLinks(*robot.model, joints);
  } catch (const urdf::UrdfError& error) {
    throw SourceError(path.string() + ": " + error.what());
  }
  robot.name = robot.model->name;
  robot.meshes = std::make_shared<urdf::MeshSearch>(SearchFor(*robot.model, path, package_path));
  return robot;
}

std::vector<fs::path> FilesOfRobot(const fs::path& urdf) {
  std::set<fs::path> files = {urdf};
  try {
    const urdf::RobotModel model = urdf::ParseUrdf(ReadUrdfFile(urdf));
    const urdf::MeshSearch search = urdf::MakeMeshSearch(urdf, {});
    for (const urdf::Link& link : model.links) {
      for (const urdf::Visual& visual : link.visuals) {
        if (visual.geometry.kind != urdf::Geometry::Kind::kMesh) continue;
        const auto found = urdf::FindMesh(visual.geometry.mesh_uri, search);
        if (const auto* mesh = std::get_if<fs::path>(&found)) {
          for (fs::path& file : urdf::FilesOfMesh(*mesh)) files.insert(std::move(file));
        }
      }
    }
  } catch (const std::runtime_error&) {  // drawing it will say why
  }
  return {files.begin(), files.end()};
}

void SetOpacity(RobotState& robot, double opacity) {
  if (opacity >= 1) return;
  robot.model = std::make_shared<const urdf::RobotModel>(urdf::Translucent(*robot.model, opacity));
}

RobotState Lifted(RobotState robot, double by) {
  const Eigen::Vector3d up(0, 0, by);
  for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(up);
  robot.bounds.translate(up);
  return robot;
}

void StandOnFloor(RobotState& robot, double x, double y) {
  KINESCOPE_CHECK(!robot.bounds.isEmpty());
  const Eigen::Vector3d middle = robot.bounds.center();
  const Eigen::Vector3d shift(x - middle.x(), y - middle.y(), -robot.bounds.min().z());
  for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(shift);
  robot.bounds.translate(shift);
}

}  // namespace kinescope::app
