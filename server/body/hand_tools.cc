#include "server/body/hand_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "server/body/figure_meshes.h"
#include "urdf/placed_mass.h"
#include "urdf/skeleton.h"

namespace kinescope::app {
namespace {

constexpr double kFarthestTool = 2;  // m, of its origin from the hand's, as of a load

Eigen::Isometry3d ToPlace(const std::string& text) {
  const std::vector<double> n = urdf::ParseNumbers(text);
  if (n.size() != 3 && n.size() != 6) {
    throw std::invalid_argument(fmt::format("'@{}' has {} numbers", text, n.size()));
  }
  Eigen::Isometry3d place(Eigen::Translation3d(n[0], n[1], n[2]));
  if (!(place.translation().norm() <= kFarthestTool)) {
    throw std::invalid_argument(fmt::format("'@{}' is more than {} m away", text, kFarthestTool));
  }
  if (n.size() == 6) {
    place.rotate(Eigen::AngleAxisd(n[5], Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(n[4], Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(n[3], Eigen::Vector3d::UnitX()));
  }
  return place;
}

// One of the list. The last '@' counts: a file's name may have others.
std::pair<urdf::Side, HandTool> ToTool(const std::string& text,
                                       const urdf::MeshConvention& convention) {
  const std::size_t colon = text.find(':');
  const std::string where = text.substr(0, colon);
  if (colon == std::string::npos || (where != "right" && where != "left")) {
    throw std::invalid_argument(fmt::format("'{}' names no hand", text));
  }
  const urdf::Side side = where == "right" ? urdf::kRight : urdf::kLeft;
  HandTool tool;
  std::string file = text.substr(colon + 1);
  if (const std::size_t at = file.rfind('@'); at != std::string::npos) {
    tool.hand_from_tool = ToPlace(file.substr(at + 1));
    file.resize(at);
  }
  if (file.empty()) throw std::invalid_argument(fmt::format("'{}' names no file", text));
  tool.mesh = ReadOwnMesh("--tool", file, convention, urdf::HandSegmentOf(side));
  return {side, std::move(tool)};
}

}  // namespace

std::shared_ptr<const HandTools> ReadHandTools(const std::string& text,
                                               const urdf::MeshConvention& convention) try {
  if (text.empty()) return nullptr;
  urdf::MeshConvention as_placed = convention;
  as_placed.frame = urdf::MeshConvention::Frame::kLink;
  auto tools = std::make_shared<HandTools>();
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    auto [side, tool] = ToTool(text.substr(begin, end - begin), as_placed);
    if ((*tools)[side]) throw std::invalid_argument("two tools for one hand");
    (*tools)[side] = std::move(tool);
    begin = end + 1;
  }
  return tools;
} catch (const std::invalid_argument& error) {
  throw UsageError(fmt::format(
      "--tool={}: {}; expected right:FILE or left:FILE, @X,Y,Z or @X,Y,Z,ROLL,PITCH,YAW after it "
      "(m and rad, in the hand's link frame, within {} m), with ';' between two",
      text, error.what(), kFarthestTool));
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
