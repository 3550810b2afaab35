#include "server/body/hand_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "server/body/custom_body_meshes.h"
#include "server/options/text.h"
#include "urdf/mesh_inputs.h"

namespace kinescope::app {
namespace {

using options::BadValue;

constexpr double kFarthestTool = 2;  // m, of its origin from the hand's, as of a load

std::optional<Eigen::Isometry3d> PlaceInHand(const std::string& text) {
  const auto numbers = options::ParseNumbers(text);
  if (!numbers || (numbers->size() != 3 && numbers->size() != 6)) return std::nullopt;
  const std::vector<double>& n = *numbers;
  Eigen::Isometry3d place(Eigen::Translation3d(n[0], n[1], n[2]));
  if (!(place.translation().norm() <= kFarthestTool)) return std::nullopt;
  if (n.size() == 6) {
    place.rotate(Eigen::AngleAxisd(n[5], Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(n[4], Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(n[3], Eigen::Vector3d::UnitX()));
  }
  return place;
}

}  // namespace

void ToolsValue::Parse(const std::string& text) {
  std::array<std::optional<ToolFile>, 2> files;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t colon = item.find(':');
    const std::string where = item.substr(0, colon);
    if (colon == std::string::npos || (where != "right" && where != "left")) RefuseText();
    ToolFile file{item.substr(colon + 1), std::nullopt};
    if (const auto parts = options::SplitAtLast(file.path, '@')) {
      file.hand_from_tool = PlaceInHand(parts->second);
      if (!file.hand_from_tool) RefuseText();
      file.path = parts->first;
    }
    auto& place = files[where == "right" ? urdf::kRight : urdf::kLeft];
    if (place) throw BadValue("two tools for the " + where + " hand; give one");
    if (file.path.empty()) RefuseText();
    place = std::move(file);
  }
  value_ = std::move(files);
  text_ = text;
}

std::string ToolsValue::Expected() const {
  return fmt::format(
      "right:FILE or left:FILE, then @X,Y,Z or @X,Y,Z,ROLL,PITCH,YAW (m and rad, in the hand's "
      "link "
      "frame, within {} m), with ; between two",
      kFarthestTool);
}

std::vector<std::filesystem::path> ToolsValue::Files() const {
  std::vector<std::filesystem::path> files;
  for (const auto& file : value_) {
    if (!file) continue;
    for (auto& path : urdf::FilesOfMesh(file->path)) files.push_back(std::move(path));
  }
  return files;
}

void ToolsValue::SetFolder(const std::filesystem::path& folder) {
  std::string text;
  std::size_t begin = 0;
  while (begin < text_.size()) {  // "right:FILE@...;left:FILE@..."
    const std::size_t end = std::min(text_.find(';', begin), text_.size());
    const std::size_t file = std::min(text_.find(':', begin), end - 1) + 1;
    if (!text.empty()) text += ';';
    text += text_.substr(begin, file - begin) + (folder / text_.substr(file, end - file)).string();
    begin = end + 1;
  }
  Parse(text);
}

std::shared_ptr<const HandTools> ReadHandTools(const ToolsValue& files,
                                               const urdf::MeshConvention& convention) {
  if (files.is_empty()) return nullptr;
  urdf::MeshConvention as_placed = convention;
  as_placed.frame = urdf::MeshConvention::Frame::kLink;
  auto tools = std::make_shared<HandTools>();
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const auto& file = (*files)[side];
    if (!file) continue;
    (*tools)[side] =
        HandTool{ReadOwnMesh("--tool", file->path, as_placed, urdf::HandSegmentOf(side)),
                 file->hand_from_tool};
  }
  return tools;
}

urdf::TriangleMesh ToHandFrame(const HandTool& tool, const urdf::Skeleton& skeleton,
                               urdf::Side side) {
  const Eigen::Affine3f place =
      Eigen::Affine3d(tool.hand_from_tool.value_or(
                          Eigen::Isometry3d(Eigen::Translation3d(urdf::GripPoint(skeleton, side)))))
          .cast<float>();
  urdf::TriangleMesh mesh = tool.mesh;
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = place * vertex;
  for (Eigen::Vector3f& normal : mesh.normals) normal = place.linear() * normal;
  return mesh;
}

}  // namespace kinescope::app
