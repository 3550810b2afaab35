#include "urdf/loft.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using SectionShape = Eigen::Matrix<double, 8, 1>;

// Where the outline runs on, the first ring of a cap lies this deep below the neighbour's surface:
// enough for neither to shine through the other. Deeper, and a viewer who takes normals from the
// triangles would see an edge.
constexpr double kJustBelow = 2e-4;  // m

double FirstAngle(double depth) { return std::min(std::sqrt(2 * kJustBelow / depth), 0.2); }

// Angle of the k-th ring of a cap that is `depth` long, from where it begins. Evenly spaced; but
// where the outline runs on, denser at the beginning, which shows when the joint turns.
double CapAngle(int k, int count, double depth, bool runs_on) {
  if (!runs_on) return M_PI_2 * (k + 1) / (count + 1);
  const double first = FirstAngle(depth);
  return first + (M_PI_2 - first) * std::pow(static_cast<double>(k) / count, 1.8);
}

// |x|^(2/power) with the sign of x: the coordinate of a superellipse.
double Rounded(double x, double power) {
  return std::copysign(std::pow(std::abs(x), 2 / power), x);
}

struct Ring {
  double at;
  double into_cap = 0;  // sine of the cap's angle; negative in the cap at the start
  double shrink = 1;    // its cosine
};

// The rings between both caps. Where the outline runs on, one lies beside the first ring of the
// neighbour's cap: else that would look out where a facet cuts a curve short.
std::vector<Ring> BodyRings(const LoftRange& range, double start_step, double end_step) {
  const double from = range.from + start_step;
  const double to = range.to - end_step;
  const int inner = range.rings - (start_step > 0 ? 1 : 0) - (end_step > 0 ? 1 : 0);
  std::vector<Ring> rings;
  if (start_step > 0) rings.push_back({range.from});
  for (int i = 0; i < inner; ++i) rings.push_back({from + (to - from) * i / (inner - 1)});
  if (end_step > 0) rings.push_back({range.to});
  return rings;
}

// The rings from start to end, without the poles that close both ends. `start_radius` and
// `end_radius` are the largest there, in the line's parameter.
std::vector<Ring> RingsOf(const LoftRange& range, double start_radius, double end_radius) {
  const auto step = [&](bool runs_on, double depth, double radius) {
    const double longest = 0.25 * (range.to - range.from);
    return runs_on ? std::min(radius * std::sin(FirstAngle(depth)), longest) : 0;
  };
  std::vector<Ring> rings;
  for (int k = range.start_rings - 1; k >= 0; --k) {
    const double angle = CapAngle(k, range.start_rings, range.start_cap, range.start_runs_on);
    rings.push_back({range.from, -std::sin(angle), std::cos(angle)});
  }
  const std::vector<Ring> body =
      BodyRings(range, step(range.start_runs_on, range.start_cap, start_radius),
                step(range.end_runs_on, range.end_cap, end_radius));
  rings.insert(rings.end(), body.begin(), body.end());
  for (int k = 0; k < range.end_rings; ++k) {
    const double angle = CapAngle(k, range.end_rings, range.end_cap, range.end_runs_on);
    rings.push_back({range.to, std::sin(angle), std::cos(angle)});
  }
  return rings;
}

// Of vertices from the triangles from `first` on: what lies beside them, weighted by area.
std::vector<Eigen::Vector3f> MeanNormals(std::size_t first, const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = first; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3f area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] += area;
  }
  for (Eigen::Vector3f& normal : normals) normal.normalize();
  return normals;
}

class Lofter {
 public:
  Lofter(const LoftAxis& axis, const Profile& profile, const LoftRange& range)
      : axis_(axis), profile_(profile), range_(range) {}

  // `turn` is in radians, from +u towards +v. Caps take profile and line on, so that within a
  // neighbour of the same they lie below its surface.
  Vector3d Point(const Ring& ring, double turn) const {
    const double angle = turn - range_.crowd_u * std::sin(turn);
    double at = ring.at;
    if (ring.into_cap != 0) {
      const bool at_start = ring.into_cap < 0;
      double depth = at_start ? range_.start_cap : range_.end_cap;
      if (at_start ? range_.start_runs_on : range_.end_runs_on) {
        const double radius = Outline(profile_.At(ring.at), angle).norm();
        depth += (radius - depth) * ring.shrink * ring.shrink;
      }
      at += ring.into_cap * depth * InAt(ring.at);
    }
    const SectionShape shape = profile_.At(at);
    const Eigen::Vector2d uv = ring.shrink * Outline(shape, angle);
    return Raised(Center(at, shape) + axis_.scale * (uv.x() * axis_.u + uv.y() * axis_.v), at);
  }

  // Across the smooth surface, not across the facets that stand for it: two segments that share a
  // surface are shaded alike where they meet, whatever their triangles. Zero where it has no
  // direction.
  Vector3d Normal(const Ring& ring, double turn) const {
    constexpr double kStep = 1e-4;  // rad, and of the line's parameter
    const auto along = [&](double step) {
      if (ring.into_cap == 0) return Point({ring.at + step}, turn);
      const double angle = std::asin(ring.into_cap) + step;
      return Point({ring.at, std::sin(angle), std::cos(angle)}, turn);
    };
    const Vector3d around = Point(ring, turn + kStep) - Point(ring, turn - kStep);
    return around.cross(along(kStep) - along(-kStep)).normalized();
  }

  Vector3d StartPole() const {
    const double at = range_.from - range_.start_cap * InAt(range_.from);
    return Raised(Center(at, profile_.At(at)), at);
  }
  Vector3d EndPole() const {
    const double at = range_.to + range_.end_cap * InAt(range_.to);
    return Raised(Center(at, profile_.At(at)), at);
  }

  // Of the section `at`, in the line's parameter.
  double LargestRadius(double at) const {
    double largest = 0;
    for (int i = 0; i < range_.points; ++i) {
      const double turn = 2 * M_PI * i / range_.points;
      largest = std::max(largest, Outline(profile_.At(at), turn).norm());
    }
    return largest * InAt(at);
  }

 private:
  static Eigen::Vector2d Outline(const SectionShape& shape, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double power = shape[c >= 0 ? Section::kPowerPlusU : Section::kPowerMinusU];
    return {Rounded(c, power) * shape[c >= 0 ? Section::kPlusU : Section::kMinusU],
            Rounded(s, power) * shape[s >= 0 ? Section::kPlusV : Section::kMinusV]};
  }

  Vector3d Raised(const Vector3d& point, double at) const {
    return axis_.relief ? Vector3d(point + axis_.relief(point, at)) : point;
  }

  Vector3d Center(double at, const SectionShape& shape) const {
    return axis_.line.At(at) +
           axis_.scale * (shape[Section::kCenterU] * axis_.u + shape[Section::kCenterV] * axis_.v);
  }

  // How much of the line's parameter a metre of a cap is.
  double InAt(double at) const {
    // A skeleton from a stream may have segments of no length; their surface still has to be one.
    constexpr double kShortest = 1e-3;
    return axis_.scale / std::max(axis_.line.Tangent(at).norm(), kShortest);
  }

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
  const auto slope =
      [&](std::size_t k) -> SectionShape {  // through both neighbours, level at the ends
    if (k == 0 || k + 1 == sections_.size()) return SectionShape::Zero();
    return (sections_[k + 1].shape - sections_[k - 1].shape) /
           (sections_[k + 1].at - sections_[k - 1].at);
  };
  const double s = (at - a.at) / width;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a.shape + (s3 - 2 * s2 + s) * width * slope(i) +
         (3 * s2 - 2 * s3) * b.shape + (s3 - s2) * width * slope(i + 1);
}

Profile Profile::Widened(const std::function<double(double at)>& factor) const {
  Profile widened = *this;
  for (Section& section : widened.sections_) {
    const double by = factor(section.at);
    section.shape[Section::kPlusV] *= by;
    section.shape[Section::kMinusV] *= by;
  }
  return widened;
}

Profile Profile::Raised(const std::function<double(double at)>& factor) const {
  Profile raised = *this;
  for (Section& section : raised.sections_) {
    const double by = factor(section.at);
    for (const int field : {Section::kPlusU, Section::kMinusU, Section::kCenterU}) {
      section.shape[field] *= by;
    }
  }
  return raised;
}

Curve::Curve(std::vector<Vector3d> points) : points_(std::move(points)) {}

Vector3d Curve::TangentOf(std::size_t point) const {
  const std::size_t before = point == 0 ? 0 : point - 1;
  const std::size_t after = std::min(point + 1, points_.size() - 1);
  return (points_[after] - points_[before]) / static_cast<double>(after - before);
}

Vector3d Curve::At(double at) const {
  const std::size_t last = points_.size() - 1;
  if (at <= 0) return points_.front() + at * TangentOf(0);
  if (at >= static_cast<double>(last)) {
    return points_.back() + (at - static_cast<double>(last)) * TangentOf(last);
  }
  const auto i = std::min(static_cast<std::size_t>(at), last - 1);
  const double s = at - static_cast<double>(i);
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * points_[i] + (s3 - 2 * s2 + s) * TangentOf(i) +
         (3 * s2 - 2 * s3) * points_[i + 1] + (s3 - s2) * TangentOf(i + 1);
}

Vector3d Curve::Tangent(double at) const {
  constexpr double kStep = 1e-4;
  return (At(at + kStep) - At(at - kStep)) / (2 * kStep);
}

void AddLoft(const LoftAxis& axis, const Profile& profile, const LoftRange& range,
             TriangleMesh& mesh) {
  const Lofter lofter(axis, profile, range);
  const Vector3d way = axis.line.Tangent(0.5 * (range.from + range.to));
  const bool is_left_handed = axis.u.cross(axis.v).dot(way) < 0;
  const std::vector<Ring> rings =
      RingsOf(range, lofter.LargestRadius(range.from), lofter.LargestRadius(range.to));
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
  mesh.vertices.push_back(lofter.StartPole().cast<float>());
  mesh.vertices.push_back(lofter.EndPole().cast<float>());

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

  const std::vector<Eigen::Vector3f> mean = MeanNormals(first_triangle, mesh);
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < points; ++i) {
      const Vector3d normal = (is_left_handed ? -1 : 1) * lofter.Normal(ring, turn(i));
      const Eigen::Vector3f& beside = mean[mesh.normals.size()];
      mesh.normals.push_back(normal.isZero() ? beside : Eigen::Vector3f(normal.cast<float>()));
    }
  }
  mesh.normals.push_back(mean[start_pole]);
  mesh.normals.push_back(mean[end_pole]);
}

void ComputeNormals(TriangleMesh& mesh) { mesh.normals = MeanNormals(0, mesh); }

}  // namespace kinescope::urdf
