#include "render/shape/line_mesh.h"

#include <algorithm>
#include <cmath>

#include "urdf/turn_between.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

void AppendCap(const Vector3d& center, const Vector3d& outward, std::uint32_t ring, int sides,
               bool is_last, urdf::Mesh& mesh) {
  const Vector3f normal = outward.cast<float>();
  const std::uint32_t middle = mesh.AddVertex(center.cast<float>(), normal);
  std::vector<std::uint32_t> rim;
  rim.reserve(static_cast<std::size_t>(sides));
  for (int i = 0; i < sides; ++i) {
    rim.push_back(mesh.AddVertex(mesh.positions[ring + static_cast<std::uint32_t>(i)], normal));
  }
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = rim[static_cast<std::size_t>(i)];
    const std::uint32_t b = rim[static_cast<std::size_t>((i + 1) % sides)];
    mesh.AddTriangle(middle, is_last ? a : b, is_last ? b : a);
  }
}

// Away from neighbours: the mean of the directions to and from a point.
Vector3d DirectionAt(const std::vector<TubePoint>& points, std::size_t i) {
  Vector3d along = Vector3d::Zero();
  if (i > 0) along += (points[i].position - points[i - 1].position).normalized();
  if (i + 1 < points.size()) along += (points[i + 1].position - points[i].position).normalized();
  if (along.norm() < 1e-9) along = points[i].position - points[i - 1].position;  // turns back
  return along.normalized();
}

}  // namespace

urdf::Mesh ConeMesh(int sides) {
  urdf::Mesh mesh;
  const float slope = static_cast<float>(M_SQRT1_2);  // as high as wide
  const auto on_circle = [&](double i) {
    const double angle = 2 * M_PI * i / sides;
    return Vector3f(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0);
  };
  for (int i = 0; i < sides; ++i) {
    const Vector3f out = on_circle(i);
    mesh.AddVertex(out, slope * (out + Vector3f::UnitZ()));
  }
  for (int i = 0; i < sides; ++i) {
    const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>((i + 1) % sides);
    const std::uint32_t tip =
        mesh.AddVertex(Vector3f::UnitZ(), slope * (on_circle(i + 0.5) + Vector3f::UnitZ()));
    mesh.AddTriangle(a, b, tip);
  }
  AppendCap(Vector3d::Zero(), -Vector3d::UnitZ(), 0, sides, false, mesh);
  return mesh;
}

void AppendTube(const std::vector<TubePoint>& all, int sides, int part, urdf::Mesh& to) {
  std::vector<TubePoint> points;
  for (const TubePoint& point : all) {
    const bool is_new = points.empty() || (point.position - points.back().position).norm() > 1e-6;
    if (is_new) points.push_back(point);
  }
  if (points.size() < 2) return;
  const auto first = static_cast<std::uint32_t>(to.positions.size());
  Vector3d across = DirectionAt(points, 0).unitOrthogonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d along = DirectionAt(points, i);
    across -= across.dot(along) * along;  // turned along with the line, so that nothing twists
    across = across.norm() > 1e-6 ? Vector3d(across.normalized()) : along.unitOrthogonal();
    const Vector3d other = along.cross(across);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * M_PI * k / sides;
      const Vector3d out = std::cos(angle) * across + std::sin(angle) * other;
      to.AddVertex((points[i].position + points[i].radius * out).cast<float>(), out.cast<float>());
    }
    to.Paint(to.positions.size() - static_cast<std::size_t>(sides), points[i].color, part);
  }
  const auto around = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = first + i * around + k, b = first + i * around + (k + 1) % around;
      to.AddTriangle(a, b, b + around);
      to.AddTriangle(a, b + around, a + around);
    }
  }
  const std::uint32_t last = first + static_cast<std::uint32_t>(points.size() - 1) * around;
  const std::size_t caps = to.positions.size();
  AppendCap(points.front().position, -DirectionAt(points, 0), first, sides, false, to);
  to.Paint(caps, points.front().color, part);
  const std::size_t end = to.positions.size();
  AppendCap(points.back().position, DirectionAt(points, points.size() - 1), last, sides, true, to);
  to.Paint(end, points.back().color, part);
}

urdf::Mesh ArrowMesh(double length, double shaft, double head, double head_length, int sides) {
  head_length = std::min(head_length, length);
  urdf::Mesh mesh;
  const double body = length - head_length;
  if (body > 0) {
    mesh.Append(urdf::CylinderMesh(shaft, body, {0, sides, 0}),
                Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.5 * body)));
  }
  Eigen::Affine3d place(Eigen::Translation3d(0, 0, body));
  place.scale(Vector3d(head, head, head_length));
  mesh.Append(ConeMesh(sides), place);
  return mesh;
}

Eigen::Quaterniond AlongZ(const Vector3d& direction) {
  return urdf::TurnBetween(Vector3d::UnitZ(), direction);
}

}  // namespace kinescope::render
