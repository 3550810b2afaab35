#include "render/shape/marker_mesh.h"

#include <array>

#include "render/shape/line_mesh.h"

namespace kinescope::render {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using Eigen::Vector4f;

constexpr int kRoundSides = 28, kListSphereSides = 12, kLineSides = 8;

// Of edge 1, sharp: lists may have many.
urdf::Mesh PlainCube() {
  urdf::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const Vector3d out = side * Vector3d::Unit(axis);
      const Vector3d u = Vector3d::Unit((axis + 1) % 3), v = out.cross(u);
      const auto corner = [&](int a, int b) {
        return mesh.AddVertex((0.5 * (out + a * u + b * v)).cast<float>(), out.cast<float>());
      };
      const std::uint32_t first = corner(-1, -1);
      corner(1, -1);
      corner(1, 1);
      corner(-1, 1);
      mesh.AddTriangle(first, first + 1, first + 2);
      mesh.AddTriangle(first, first + 2, first + 3);
    }
  }
  return mesh;
}

class Writer {
 public:
  Writer(const SceneMarker& marker, urdf::Mesh& to)
      : marker_(marker),
        world_from_marker_(Eigen::Translation3d(marker.pose.position) * marker.pose.orientation),
        to_(to) {}

  void Add(const urdf::Mesh& mesh, const Affine3d& marker_from_mesh, const Vector4f& color) {
    const std::size_t first = to_.positions.size();
    to_.Append(mesh, world_from_marker_ * marker_from_mesh);
    to_.Paint(first, color, 0);
  }

  void AddScaled(const urdf::Mesh& mesh) {
    Add(mesh, Affine3d(Eigen::Scaling(marker_.scale)), Color());
  }

  void AddAtPoints(const urdf::Mesh& mesh, const Vector3d& size) {
    for (std::size_t i = 0; i < marker_.points.size(); ++i) {
      Add(mesh, Eigen::Translation3d(marker_.points[i]) * Eigen::Scaling(size), ColorAt(i));
    }
  }

  void AddLine(std::size_t first, std::size_t end) {
    std::vector<TubePoint> points;
    for (std::size_t i = first; i < end; ++i) {
      points.push_back(
          {world_from_marker_ * marker_.points[i], 0.5 * marker_.scale.x(), ColorAt(i)});
    }
    AppendTube(points, kLineSides, 0, to_);
  }

  void AddArrow() {
    const Vector3d& size = marker_.scale;
    Affine3d place = Affine3d::Identity();
    if (marker_.points.empty()) {  // as RViz has it: the head is 23 %, and twice as thick
      place.rotate(AlongZ(Vector3d::UnitX()));
      // Turned so, its x is the height and its y the width.
      place.scale(Vector3d(size.z(), size.y(), 1));
      Add(ArrowMesh(size.x(), 0.5, 1, 0.23 * size.x(), kRoundSides), place, Color());
      return;
    }
    const Vector3d along = marker_.points[1] - marker_.points[0];
    const double length = along.norm();
    if (!(length > 0)) return;
    place.translate(marker_.points[0]);
    place.rotate(AlongZ(along));
    const double head_length = size.z() > 0 ? size.z() : 0.23 * length;
    Add(ArrowMesh(length, 0.5 * size.x(), 0.5 * size.y(), head_length, kRoundSides), place,
        Color());
  }

  // Twice, for both sides.
  void AddTriangles() {
    const Affine3d place = world_from_marker_ * Eigen::Scaling(marker_.scale);
    for (std::size_t i = 0; i + 2 < marker_.points.size(); i += 3) {
      std::array<Vector3d, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = place * marker_.points[i + k];
      const Vector3d normal = (at[1] - at[0]).cross(at[2] - at[0]).normalized();
      if (!normal.allFinite()) continue;
      for (const double side : {1.0, -1.0}) {
        const auto corner = static_cast<std::uint32_t>(to_.positions.size());
        for (std::size_t k = 0; k < 3; ++k) {
          to_.AddVertex(at[k].cast<float>(), (side * normal).cast<float>());
          to_.Paint(to_.positions.size() - 1, ColorAt(i + k), 0);
        }
        to_.AddTriangle(corner, corner + (side > 0 ? 1 : 2), corner + (side > 0 ? 2 : 1));
      }
    }
  }

  Vector4f Color() const { return marker_.color.cast<float>(); }
  Vector4f ColorAt(std::size_t i) const {
    return marker_.colors.empty() ? Color() : Vector4f(marker_.colors[i].cast<float>());
  }

 private:
  const SceneMarker& marker_;
  const Affine3d world_from_marker_;
  urdf::Mesh& to_;
};

urdf::Mesh UnitSphere(int sides) { return urdf::SphereMesh(0.5, {0, 0, sides}); }
urdf::Mesh UnitCylinder() { return urdf::CylinderMesh(0.5, 1, {0, kRoundSides, 0}); }

}  // namespace

std::size_t TriangleCount(const SceneMarker& marker) {
  const std::size_t count = marker.points.size();
  switch (marker.type) {
    case MarkerType::kArrow: return ArrowMesh(1, 0.1, 0.2, 0.3, kRoundSides).triangles.size() / 3;
    case MarkerType::kCube: return PlainCube().triangles.size() / 3;
    case MarkerType::kSphere: return UnitSphere(kRoundSides).triangles.size() / 3;
    case MarkerType::kCylinder: return UnitCylinder().triangles.size() / 3;
    case MarkerType::kLineStrip:
    case MarkerType::kLineList:  // two caps for each pair
      return count * 2 * kLineSides;
    case MarkerType::kPoints: return count * 2;
    case MarkerType::kCubeList: return count * (PlainCube().triangles.size() / 3);
    case MarkerType::kSphereList:
      return count * (UnitSphere(kListSphereSides).triangles.size() / 3);
    case MarkerType::kTriangleList: return 2 * (count / 3);
    case MarkerType::kText:
    case MarkerType::kMesh: break;
  }
  return 0;
}

void AppendMarker(const SceneMarker& marker, urdf::Mesh& to) {
  Writer writer(marker, to);
  switch (marker.type) {
    case MarkerType::kArrow: writer.AddArrow(); break;
    case MarkerType::kCube: writer.AddScaled(PlainCube()); break;
    case MarkerType::kSphere: writer.AddScaled(UnitSphere(kRoundSides)); break;
    case MarkerType::kCylinder: writer.AddScaled(UnitCylinder()); break;
    case MarkerType::kLineStrip: writer.AddLine(0, marker.points.size()); break;
    case MarkerType::kLineList:
      for (std::size_t i = 0; i + 1 < marker.points.size(); i += 2) writer.AddLine(i, i + 2);
      break;
    case MarkerType::kCubeList: writer.AddAtPoints(PlainCube(), marker.scale); break;
    case MarkerType::kSphereList:
      writer.AddAtPoints(UnitSphere(kListSphereSides), Vector3d::Constant(marker.scale.x()));
      break;
    case MarkerType::kTriangleList: writer.AddTriangles(); break;
    case MarkerType::kPoints:
    case MarkerType::kText:
    case MarkerType::kMesh: break;
  }
}

}  // namespace kinescope::render
