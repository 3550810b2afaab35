#include "render/shape/surroundings_glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/color_difference.h"
#include "core/system/utf8.h"
#include "urdf/rig/glb_writer.h"

namespace kinescope::render {
namespace {

using nlohmann::json;
using rig::GlbWriter;

std::uint16_t LinearOf(float srgb) {
  constexpr double kMost = 65535;
  return static_cast<std::uint16_t>(
      std::lround(kMost * ToLinear(std::clamp(static_cast<double>(srgb), 0.0, 1.0))));
}

// The meshes of one file. Its root turns the world's axes to those of the format, so that
// everything below it is in world coordinates.
class Document {
 public:
  Document() {
    const Eigen::Quaterniond turn(rig::GlbAxes());
    nodes_ = {{{"name", "surroundings"}, {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}}};
    json& document = glb_.document();
    // Colours are those of the vertices.
    const json surface = {{"metallicFactor", 0}, {"roughnessFactor", 0.7}};
    document["materials"] = {
        {{"pbrMetallicRoughness", surface}},
        {{"pbrMetallicRoughness", surface}, {"doubleSided", true}},
        {{"pbrMetallicRoughness", surface}, {"doubleSided", true}, {"alphaMode", "BLEND"}},
        {{"name", "ground"}, {"alphaMode", "BLEND"}, {"extensions", {{kUnlit, json::object()}}}},
        {{"name", "ground depth"}, {"extensions", {{kUnlit, json::object()}}}}};
    document["extensionsUsed"] = {kUnlit};
  }

  enum Material { kClosed, kOpen, kBlended, kGround, kGroundDepth };

  struct Part {
    const urdf::Mesh& mesh;
    Material material;
  };

  void AddMeshes(const std::string& name, const std::vector<Part>& parts) {
    if (const auto mesh = AddMesh(parts)) {
      AddNode({{"name", PrintableLine(name)}, {"mesh", *mesh}}, kRoot);
    }
  }

  /// A node with one node for each of `links`, whose places are not in the file.
  void AddMovingRobot(const std::string& name, std::size_t number,
                      const std::vector<std::vector<Part>>& links) {
    const std::size_t robot =
        AddNode({{"name", PrintableLine(name)}, {"extras", {{"robot", number}}}}, kRoot);
    for (std::size_t link = 0; link < links.size(); ++link) {
      const auto mesh = AddMesh(links[link]);
      if (mesh) AddNode({{"mesh", *mesh}, {"extras", {{"link", link}}}}, robot);
    }
  }

  void AddPoints(const MarkerPoints& points) {
    constexpr int kModeOfPoints = 0;
    AddNode({{"name", "points"},
             {"mesh", AddPlaces(points, kModeOfPoints)},
             {"extras",
              {{"size", {points.size.x(), points.size.y()}}, {"in_pixels", points.is_in_pixels}}}},
            kRoot);
  }

  void AddLines(const MarkerLines& lines) {
    constexpr int kModeOfLines = 1;
    AddNode({{"name", "lines"}, {"mesh", AddPlaces(lines, kModeOfLines)}}, kRoot);
  }

  void AddLabel(const Label& label) {
    AddNode({{"name", "label"},
             {"translation", {label.position.x(), label.position.y(), label.position.z()}},
             {"extras",
              {{"text", PrintableLines(label.text)},
               {"height", label.height_m},
               {"color", label.color},
               {"opacity", label.opacity}}}},
            kRoot);
  }

  std::string Write(const std::vector<std::string>& problems) {
    json lines = json::array();
    for (const std::string& problem : problems) lines.push_back(PrintableLine(problem));
    json& document = glb_.document();
    document["nodes"] = std::move(nodes_);
    document["scenes"] = {{{"nodes", {0}}, {"extras", {{"problems", std::move(lines)}}}}};
    return glb_.Write();
  }

 private:
  static constexpr std::size_t kRoot = 0;
  static constexpr const char* kUnlit = "KHR_materials_unlit";

  // Returns its number.
  std::size_t AddNode(json node, std::size_t parent) {
    nodes_[parent]["children"].push_back(nodes_.size());
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }

  // Its number.
  std::size_t AddPlaces(const MarkerPlaces& places, int mode) {
    json& meshes = glb_.document()["meshes"];
    meshes.push_back({{"primitives",
                       {{{"mode", mode},
                         {"attributes",
                          {{"POSITION", glb_.AddPositions(Flat(places.positions))},
                           {"COLOR_0", AddColors(places.colors)}}},
                         {"material", places.is_blended ? kBlended : kClosed}}}}});
    return meshes.size() - 1;
  }

  // Its number; nullopt: there are no triangles.
  std::optional<std::size_t> AddMesh(const std::vector<Part>& parts) {
    json primitives = json::array();
    for (const Part& part : parts) {
      if (!part.mesh.triangles.empty()) primitives.push_back(Primitive(part));
    }
    if (primitives.empty()) return std::nullopt;
    json& meshes = glb_.document()["meshes"];
    meshes.push_back({{"primitives", std::move(primitives)}});
    return meshes.size() - 1;
  }

  static std::vector<float> Flat(const std::vector<Eigen::Vector3f>& vectors) {
    std::vector<float> flat;
    flat.reserve(3 * vectors.size());
    for (const Eigen::Vector3f& v : vectors) flat.insert(flat.end(), v.begin(), v.end());
    return flat;
  }

  // The number of its accessor.
  std::size_t AddColors(const std::vector<Eigen::Vector4f>& srgb) {
    std::vector<std::uint16_t> colors;
    colors.reserve(4 * srgb.size());
    for (const Eigen::Vector4f& c : srgb) {
      for (int i = 0; i < 3; ++i) colors.push_back(LinearOf(c[i]));
      colors.push_back(static_cast<std::uint16_t>(65535 * std::clamp(c.w(), 0.0f, 1.0f)));
    }
    const std::size_t number =
        glb_.Add(colors, {GlbWriter::kUnsignedShort, "VEC4", 4, GlbWriter::kOfVertices});
    glb_.document()["accessors"][number]["normalized"] = true;
    return number;
  }

  json Primitive(const Part& part) {
    const urdf::Mesh& mesh = part.mesh;
    const GlbWriter::Kind triples = {GlbWriter::kFloat, "VEC3", 3, GlbWriter::kOfVertices};
    json attributes = {{"POSITION", glb_.AddPositions(Flat(mesh.positions))},
                       {"NORMAL", glb_.Add(Flat(mesh.normals), triples)},
                       {"COLOR_0", AddColors(mesh.colors)}};
    return {{"attributes", std::move(attributes)},
            {"indices", glb_.Add(mesh.triangles,
                                 {GlbWriter::kUnsignedInt, "SCALAR", 1, GlbWriter::kOfIndices})},
            {"material", static_cast<int>(part.material)}};
  }

  GlbWriter glb_;
  json nodes_;
};

Document::Material MaterialOf(const VisualMesh& solid) {
  return solid.is_closed ? Document::kClosed : Document::kOpen;
}

// Where the robot's links are; parts of links that are nowhere are left out.
urdf::Mesh Placed(const urdf::Mesh& mesh, const RobotState& robot) {
  const auto pose_of = [&](std::size_t vertex) -> const Eigen::Isometry3d* {
    const auto link = static_cast<std::size_t>(mesh.parts[vertex]);
    if (link >= robot.world_from_link.size()) return nullptr;
    const Eigen::Isometry3d& pose = robot.world_from_link[link];
    return CanBeDrawn(pose) ? &pose : nullptr;
  };
  urdf::Mesh placed = mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Isometry3d* pose = pose_of(i);
    if (pose == nullptr) continue;
    placed.positions[i] = (*pose * mesh.positions[i].cast<double>()).cast<float>();
    placed.normals[i] = (pose->linear() * mesh.normals[i].cast<double>()).cast<float>();
  }
  placed.triangles.clear();
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    if (pose_of(mesh.triangles[i]) == nullptr) continue;
    placed.triangles.insert(placed.triangles.end(), &mesh.triangles[i], &mesh.triangles[i] + 3);
  }
  return placed;
}

}  // namespace

const SurroundingsGlb::RobotShape& SurroundingsGlb::ShapeOf(const RobotState& robot) {
  const auto [known, is_new] = robots_.try_emplace(robot.model.get());
  RobotShape& shape = known->second;
  if (!is_new) return shape;
  shape.model = robot.model;
  VisualReader reader(robot.meshes ? *robot.meshes : urdf::MeshSearch(),
                      urdf::ShapeDetail::Robot());
  for (const std::size_t link : LinksToDraw(*robot.model)) {
    if (robot.moves || shape.surfaces.empty()) shape.surfaces.emplace_back();
    Surface& surface = shape.surfaces.back();
    for (const urdf::Visual& visual : robot.model->links[link].visuals) {
      const double opacity = OpacityOf(visual);
      if (opacity <= 0) continue;
      reader.Add(visual, static_cast<int>(link), opacity < 1 ? surface.blended : surface.solid);
    }
  }
  return shape;
}

std::string SurroundingsGlb::Write(const std::vector<std::shared_ptr<const SceneMarker>>& markers,
                                   const std::vector<RobotState>& robots) {
  Document document;
  MarkerShapes shapes = markers_.Read(markers);
  document.AddMeshes("markers",
                     {{shapes.ground_depth.mesh, Document::kGroundDepth},
                      {shapes.ground.mesh, Document::kGround},
                      {shapes.solid.mesh, shapes.is_closed ? Document::kClosed : Document::kOpen},
                      {shapes.blended.mesh, Document::kBlended}});
  for (const MarkerPoints& points : shapes.points) document.AddPoints(points);
  for (const MarkerLines& lines : shapes.lines) document.AddLines(lines);
  for (const Label& label : shapes.labels) document.AddLabel(label);
  std::vector<std::string> problems = std::move(shapes.problems);
  std::size_t moving = 0;
  for (const RobotState& robot : robots) {
    const RobotShape& shape = ShapeOf(robot);
    if (robot.moves) {
      std::vector<std::vector<Document::Part>> links;
      for (const Surface& surface : shape.surfaces) {
        links.push_back({{surface.solid.mesh, MaterialOf(surface.solid)},
                         {surface.blended.mesh, Document::kBlended}});
      }
      document.AddMovingRobot("robot " + robot.name, moving++, links);
    } else {
      for (const Surface& surface : shape.surfaces) {
        document.AddMeshes("robot " + robot.name,
                           {{Placed(surface.solid.mesh, robot), MaterialOf(surface.solid)},
                            {Placed(surface.blended.mesh, robot), Document::kBlended}});
      }
    }
    for (const Surface& surface : shape.surfaces) {
      for (const VisualMesh* mesh : {&surface.solid, &surface.blended}) {
        problems.insert(problems.end(), mesh->problems.begin(), mesh->problems.end());
      }
    }
    if (!robot.problem.empty()) problems.push_back(robot.problem);
  }
  const auto is_gone = [&](const auto& known) {
    return std::none_of(robots.begin(), robots.end(),
                        [&](const RobotState& robot) { return robot.model.get() == known.first; });
  };
  for (auto it = robots_.begin(); it != robots_.end();) {
    it = is_gone(*it) ? robots_.erase(it) : std::next(it);
  }
  return document.Write(problems);
}

}  // namespace kinescope::render
