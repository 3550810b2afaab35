#include "urdf/loft.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using Shape = Eigen::Matrix<double, 8, 1>;

// Angle of the k-th ring of a cap, from where it begins. Evenly spaced; but where the outline runs
// on into a neighbour, the rings are denser at the beginning: that part shows when the joint turns.
double CapAngle(int k, int count, bool runs_on) {
  if (!runs_on) return M_PI_2 * (k + 1) / (count + 1);
  constexpr double kFirst = 0.11;
  return kFirst + (M_PI_2 - kFirst) * std::pow(static_cast<double>(k) / count, 1.5);
}

// |x|^(2/power) with the sign of x: the coordinate of a superellipse.
double Rounded(double x, double power) {
  return std::copysign(std::pow(std::abs(x), 2 / power), x);
}

struct Ring {
  double at;
  double shrink;
};

// The rings from start to end, without the poles that close both ends. Caps take the profile on, so
// that within a neighbour of the same profile they lie below its surface.
std::vector<Ring> RingsOf(const LoftRange& range, double start_cap, double end_cap) {
  std::vector<Ring> rings;
  for (int k = range.start_rings - 1; k >= 0; --k) {
    const double angle = CapAngle(k, range.start_rings, range.start_runs_on);
    rings.push_back({range.from - start_cap * std::sin(angle), std::cos(angle)});
  }
  for (int i = 0; i < range.rings; ++i) {
    rings.push_back({range.from + (range.to - range.from) * i / (range.rings - 1), 1});
  }
  for (int k = 0; k < range.end_rings; ++k) {
    const double angle = CapAngle(k, range.end_rings, range.end_runs_on);
    rings.push_back({range.to + end_cap * std::sin(angle), std::cos(angle)});
  }
  return rings;
}

// Normals of the vertices that have none yet, from the triangles from `first` on.
void AddNormals(std::size_t first, TriangleMesh& mesh) {
  const std::size_t first_vertex = mesh.normals.size();
  mesh.normals.resize(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = first; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3f area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t corner : {a, b, c}) mesh.normals[corner] += area;
  }
  for (std::size_t i = first_vertex; i < mesh.normals.size(); ++i) mesh.normals[i].normalize();
}

class Lofter {
 public:
  Lofter(const LoftAxis& axis, const Profile& profile, const LoftRange& range)
      : axis_(axis), profile_(profile), range_(range) {}

  // `turn` is in radians, from +u towards +v.
  Vector3d Point(const Ring& ring, double turn) const {
    const Shape shape = profile_.At(ring.at);
    const double angle = turn - range_.crowd_u * std::sin(turn);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double power = shape[c >= 0 ? Section::kPowerPlusU : Section::kPowerMinusU];
    const double u = Rounded(c, power) * shape[c >= 0 ? Section::kPlusU : Section::kMinusU];
    const double v = Rounded(s, power) * shape[s >= 0 ? Section::kPlusV : Section::kMinusV];
    return Center(ring.at) + axis_.scale * ring.shrink * (u * axis_.u + v * axis_.v);
  }

  // Of the profile itself, as if it had no ends: neighbours that share a profile share the normals
  // at their joint, and no seam shows. For u, v and the axis right-handed.
  Vector3d ProfileNormal(double at, double turn) const {
    constexpr double kStep = 1e-3;
    const Vector3d around = Point({at, 1}, turn + kStep) - Point({at, 1}, turn - kStep);
    const Vector3d along = Point({at + kStep, 1}, turn) - Point({at - kStep, 1}, turn);
    return around.cross(along).normalized();
  }

  Vector3d Center(double at) const {
    const Shape shape = profile_.At(at);
    return axis_.origin + at * (axis_.end - axis_.origin) +
           axis_.scale * (shape[Section::kCenterU] * axis_.u + shape[Section::kCenterV] * axis_.v);
  }

 private:
  const LoftAxis& axis_;
  const Profile& profile_;
  const LoftRange& range_;
};

}  // namespace

Section& Section::Center(double u, double v) {
  shape[kCenterU] = u;
  shape[kCenterV] = v;
  return *this;
}

Section& Section::Power(double plus_u, double minus_u) {
  shape[kPowerPlusU] = plus_u;
  shape[kPowerMinusU] = minus_u;
  return *this;
}

Section Widths(double at, double plus_u, double minus_u, double plus_v, double minus_v) {
  Section section;
  section.at = at;
  section.shape << plus_u, minus_u, plus_v, minus_v, 0, 0, 2, 2;
  return section;
}

Eigen::Matrix<double, 8, 1> Profile::At(double at) const {
  if (at <= sections_.front().at) return sections_.front().shape;
  if (at >= sections_.back().at) return sections_.back().shape;
  std::size_t i = 0;
  while (sections_[i + 1].at < at) ++i;
  const Section& a = sections_[i];
  const Section& b = sections_[i + 1];
  const double width = b.at - a.at;
  const auto slope = [&](std::size_t k) -> Shape {  // through both neighbours, level at the ends
    if (k == 0 || k + 1 == sections_.size()) return Shape::Zero();
    return (sections_[k + 1].shape - sections_[k - 1].shape) /
           (sections_[k + 1].at - sections_[k - 1].at);
  };
  const double s = (at - a.at) / width;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a.shape + (s3 - 2 * s2 + s) * width * slope(i) +
         (3 * s2 - 2 * s3) * b.shape + (s3 - s2) * width * slope(i + 1);
}

void AddLoft(const LoftAxis& axis, const Profile& profile, const LoftRange& range,
             TriangleMesh& mesh) {
  const Lofter lofter(axis, profile, range);
  // A skeleton from a stream may have segments of no length; their surface still has to be one.
  constexpr double kShortest = 1e-3;
  const Vector3d way = axis.end - axis.origin;
  const double caps_in_at = axis.scale / std::max(way.norm(), kShortest);
  const double start_cap = range.start_cap * caps_in_at;
  const double end_cap = range.end_cap * caps_in_at;
  const bool is_left_handed = axis.u.cross(axis.v).dot(way) < 0;
  const std::vector<Ring> rings = RingsOf(range, start_cap, end_cap);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto points = static_cast<std::uint32_t>(range.points);
  const auto ring_count = static_cast<std::uint32_t>(rings.size());

  const auto turn = [&](std::uint32_t point) { return 2 * M_PI * point / points; };
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < points; ++i) {
      mesh.vertices.push_back(lofter.Point(ring, turn(i)).cast<float>());
    }
  }
  const std::uint32_t start_pole = first + ring_count * points;
  const std::uint32_t end_pole = start_pole + 1;
  mesh.vertices.push_back(lofter.Center(range.from - start_cap).cast<float>());
  mesh.vertices.push_back(lofter.Center(range.to + end_cap).cast<float>());

  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (is_left_handed) std::swap(b, c);
    mesh.triangles.push_back({a, b, c});
  };
  const std::size_t first_triangle = mesh.triangles.size();
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::uint32_t next = (i + 1) % points;
    add(start_pole, first + next, first + i);
    for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
      const std::uint32_t here = first + ring * points;
      const std::uint32_t there = here + points;
      add(here + i, here + next, there + next);
      add(here + i, there + next, there + i);
    }
    const std::uint32_t last = first + (ring_count - 1) * points;
    add(end_pole, last + i, last + next);
  }

  AddNormals(first_triangle, mesh);
  const auto first_of_body = static_cast<std::uint32_t>(range.start_rings);
  const auto last_of_body = first_of_body + static_cast<std::uint32_t>(range.rings - 1);
  for (std::uint32_t ring = 0; ring < ring_count; ++ring) {
    // Where the outline runs on, the first ring of the cap is taken for a part of the profile: that
    // much of it shows as a narrow ledge when neighbours are turned against each other.
    const std::uint32_t from = range.start_runs_on ? first_of_body - 1 : first_of_body + 1;
    const std::uint32_t to = range.end_runs_on ? last_of_body + 1 : last_of_body - 1;
    if (ring < from || ring > to) continue;
    for (std::uint32_t i = 0; i < points; ++i) {
      const Vector3d normal = lofter.ProfileNormal(rings[ring].at, turn(i));
      mesh.normals[first + ring * points + i] =
          (is_left_handed ? Vector3d(-normal) : normal).cast<float>();
    }
  }
}

void ComputeNormals(TriangleMesh& mesh) {
  mesh.normals.clear();
  AddNormals(0, mesh);
}

}  // namespace kinescope::urdf
