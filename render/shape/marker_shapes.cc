#include "render/shape/marker_shapes.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "render/shape/marker_mesh.h"

namespace kinescope::render {
namespace {

constexpr std::size_t kMaxMarkers = 10'000;
constexpr std::size_t kMaxMeshFiles = 64;  // kept
constexpr std::size_t kMaxProblems = 20;   // named; a flood of markers is one fault, not thousands
constexpr char kTooManyTriangles[] = "all markers together have too many triangles";

bool IsTranslucent(const SceneMarker& marker) {
  const auto is_clear = [](const Eigen::Vector4d& color) { return color.w() < 1; };
  return marker.colors.empty() ? is_clear(marker.color)
                               : std::any_of(marker.colors.begin(), marker.colors.end(), is_clear);
}

// The lower first, so that what is above it covers it; then RViz's order of layers; then the larger
// first, so that the map of a robot's surroundings is seen on that of the building.
struct GroundOrder {
  explicit GroundOrder(const SceneMarker& marker) : layer(marker.ground) {
    constexpr double kLevel = 0.05;  // m; those of one level are coplanar
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& point : marker.points) box.extend(point.head<2>());
    const Eigen::Vector3d first =
        marker.pose.position + marker.pose.orientation * marker.points.front();
    level = std::round(first.z() / kLevel);
    area = marker.scale.head<2>().prod() * box.volume();
  }
  bool operator<(const GroundOrder& other) const {
    return std::tuple(level, layer, other.area) < std::tuple(other.level, other.layer, area);
  }

  double level = 0;
  GroundLayer layer;
  double area = 0;
};

SceneMarker ListOf(const SceneMarker& strip) {
  SceneMarker list = strip;
  list.type = MarkerType::kLineList;
  list.points.clear();
  list.colors.clear();
  for (std::size_t i = 0; i + 1 < strip.points.size(); ++i) {
    list.points.insert(list.points.end(), {strip.points[i], strip.points[i + 1]});
    if (!strip.colors.empty()) {
      list.colors.insert(list.colors.end(), {strip.colors[i], strip.colors[i + 1]});
    }
  }
  return list;
}

Label TextOf(const SceneMarker& marker) {
  constexpr double kCapital = 0.62;  // of a line's height; measured in pictures of RViz 1.14
  const Eigen::Vector4d& c = marker.color;
  const Rgb rgb = {c.x(), c.y(), c.z()};
  return {marker.pose.position,        marker.text, Label::Kind::kMarker,
          kCapital * marker.scale.z(), rgb,         c.w()};
}

// As RViz tints what a file has: with the opacity of the message, and its colour once more over it.
Eigen::Vector4f Tinted(const Eigen::Vector4f& of_file, const Eigen::Vector4d& color) {
  const auto opacity = static_cast<float>(color.w());
  const float over = std::min(opacity, 0.5f), under = (1 - over) * opacity;
  if (!(opacity > 0)) return Eigen::Vector4f::Zero();
  Eigen::Vector4f tinted = (over * color.cast<float>() + under * of_file) / (over + under);
  tinted.w() = over + under;
  return tinted;
}

// @return around them
Eigen::AlignedBox3f Put(const SceneMarker& marker, MarkerPlaces& to) {
  const auto world_from_marker =
      Eigen::Translation3d(marker.pose.position) * marker.pose.orientation;
  Eigen::AlignedBox3f box;
  to.name = IdentityOf(marker);
  to.is_blended = IsTranslucent(marker);
  to.positions.reserve(marker.points.size());
  to.colors.reserve(marker.points.size());
  for (std::size_t i = 0; i < marker.points.size(); ++i) {
    to.positions.emplace_back((world_from_marker * marker.points[i]).cast<float>());
    box.extend(to.positions.back());
    const Eigen::Vector4d& color = marker.colors.empty() ? marker.color : marker.colors[i];
    to.colors.emplace_back(color.cast<float>());
  }
  return box;
}

std::string NotDrawn(const SceneMarker& marker, const std::string& why) {
  return "marker " + IdentityOf(marker) + " is not drawn: " + why;
}

void Shorten(std::vector<std::string>& problems) {
  if (problems.size() <= kMaxProblems) return;
  const std::size_t more = problems.size() - kMaxProblems;
  problems.resize(kMaxProblems);
  problems.push_back("and " + std::to_string(more) + " more markers");
}

}  // namespace

MarkerShapes MarkerReader::Read(const std::vector<std::shared_ptr<const SceneMarker>>& markers) {
  triangles_ = 0;
  MarkerShapes shapes;
  const std::size_t count = std::min(markers.size(), kMaxMarkers);
  std::vector<std::pair<GroundOrder, const SceneMarker*>> ground;
  for (std::size_t i = 0; i < count; ++i) {
    const SceneMarker& marker = *markers[i];
    if (marker.ground == GroundLayer::kNone || FindDefect(marker) || marker.points.empty()) {
      Add(marker, shapes);
    } else {
      ground.emplace_back(marker, &marker);
    }
  }
  std::stable_sort(ground.begin(), ground.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [order, marker] : ground) {
    const std::size_t before = shapes.ground.names.size();
    AddTo(shapes.ground, *marker, shapes);
    const bool is_drawn = shapes.ground.names.size() > before;
    if (is_drawn && !IsTranslucent(*marker)) AppendMarker(*marker, shapes.ground_depth.mesh);
  }
  if (markers.size() > kMaxMarkers) {
    shapes.problems.push_back(
        NotDrawn(*markers[kMaxMarkers], "there are " + std::to_string(markers.size()) +
                                            " markers, more than " + std::to_string(kMaxMarkers)));
  }
  Shorten(shapes.problems);
  return shapes;
}

bool MarkerReader::HasRoomFor(std::size_t triangles) {
  if (triangles_ + triangles > most_triangles_) return false;
  triangles_ += triangles;
  return true;
}

void MarkerReader::Add(const SceneMarker& marker, MarkerShapes& to) {
  if (const auto defect = FindDefect(marker)) {
    to.problems.push_back(NotDrawn(marker, defect->text));
    return;
  }
  if (marker.type == MarkerType::kText) {
    to.labels.push_back(TextOf(marker));
    return;
  }
  if (marker.type == MarkerType::kPoints) {
    if (HasRoomFor(TriangleCount(marker))) return AddPoints(marker, to);
    to.problems.push_back(NotDrawn(marker, kTooManyTriangles));
    return;
  }
  const bool is_strip = marker.type == MarkerType::kLineStrip;
  if ((is_strip || marker.type == MarkerType::kLineList) && marker.is_in_pixels) {
    if (HasRoomFor(marker.points.size())) return AddLines(is_strip ? ListOf(marker) : marker, to);
    to.problems.push_back(NotDrawn(marker, kTooManyTriangles));
    return;
  }
  AddTo(IsTranslucent(marker) ? to.blended : to.solid, marker, to);
}

void MarkerReader::AddTo(MarkerSurface& surface, const SceneMarker& marker, MarkerShapes& to) {
  urdf::Mesh& mesh = surface.mesh;
  const std::size_t first = mesh.positions.size();
  if (marker.type == MarkerType::kMesh) {
    AddMesh(marker, mesh, to);
  } else if (HasRoomFor(TriangleCount(marker))) {
    AppendMarker(marker, mesh);
  } else {
    to.problems.push_back(NotDrawn(marker, kTooManyTriangles));
  }
  if (mesh.positions.size() == first) return;
  Eigen::AlignedBox3f& box = to.boxes.emplace_back().box;
  for (std::size_t i = first; i < mesh.positions.size(); ++i) {
    box.extend(mesh.positions[i]);
    mesh.parts[i] = static_cast<float>(surface.names.size());
  }
  surface.names.push_back(IdentityOf(marker));
}

void MarkerReader::AddPoints(const SceneMarker& marker, MarkerShapes& to) {
  MarkerPoints& points = to.points.emplace_back();
  points.size = marker.scale.head<2>().cast<float>();
  points.is_in_pixels = marker.is_in_pixels;
  auto& [box, around_px] = to.boxes.emplace_back();
  box = Put(marker, points);
  if (points.is_in_pixels) {
    around_px = 0.5f * points.size.maxCoeff();
    return;
  }
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(0.5f * points.size.norm());
  box = {box.min() - reach, box.max() + reach};
}

void MarkerReader::AddLines(const SceneMarker& marker, MarkerShapes& to) {
  const Eigen::AlignedBox3f box = Put(marker, to.lines.emplace_back());
  to.boxes.push_back({box, 1});
}

const VisualMesh& MarkerReader::MeshOf(const std::string& uri) {
  const auto known = meshes_.find(uri);
  if (known != meshes_.end()) return known->second;
  if (meshes_.size() >= kMaxMeshFiles) meshes_.clear();
  urdf::Visual visual;
  visual.geometry = {urdf::Geometry::Kind::kMesh, Eigen::Vector3d::Ones(), uri};
  visual.rgba = Eigen::Vector4d::Zero();  // stays where the file has no colour
  VisualReader reader(urdf::MakeMeshSearch({}, {}), urdf::ShapeDetail::Robot());
  VisualMesh& mesh = meshes_[uri];
  reader.Add(visual, 0, mesh);
  return mesh;
}

void MarkerReader::AddMesh(const SceneMarker& marker, urdf::Mesh& mesh, MarkerShapes& to) {
  const VisualMesh& file = MeshOf(marker.mesh_uri);
  for (const std::string& problem : file.problems) {
    to.problems.push_back("marker " + IdentityOf(marker) + ": " + problem);
  }
  const bool is_file = file.placeholders.empty();
  Eigen::Affine3d place(Eigen::Translation3d(marker.pose.position) * marker.pose.orientation);
  if (is_file) {
    place.scale(marker.scale);
  } else {
    to.labels.push_back(
        {marker.pose.position, file.placeholders.front().label, Label::Kind::kFault});
  }
  if (!HasRoomFor(file.mesh.triangles.size() / 3)) {
    to.problems.push_back(NotDrawn(marker, kTooManyTriangles));
    return;
  }
  to.is_closed = to.is_closed && file.is_closed;
  const std::size_t first = mesh.positions.size();
  mesh.Append(file.mesh, place);
  const bool is_tinted = !marker.mesh_has_own_colors || !marker.color.isZero();
  const Eigen::Vector4f usual(0.8f, 0.8f, 0.8f, 1);  // of a file that has no colours, as of STL
  if (is_file) mesh.Paint(first, is_tinted ? marker.color.cast<float>() : usual, 0);
  if (!marker.mesh_has_own_colors || !is_file) return;
  for (std::size_t i = 0; i < file.mesh.colors.size(); ++i) {
    const Eigen::Vector4f& color = file.mesh.colors[i];
    if (color.w() > 0) mesh.colors[first + i] = is_tinted ? Tinted(color, marker.color) : color;
  }
}

}  // namespace kinescope::render
