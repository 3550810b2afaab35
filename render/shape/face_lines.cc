#include "render/shape/face_lines.h"

#include <Eigen/Geometry>
#include <optional>

#include "urdf/skin/bind_pose.h"

namespace kinescope::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Left and up from the joint of the head, m, of the man whose face urdf/skin/make shapes.
using FaceCurve = std::vector<Vector2d>;
const FaceCurve kMouth = {{-0.0235, 0.0118}, {-0.0160, 0.0104}, {-0.0060, 0.0110}, {0, 0.0104},
                          {0.0060, 0.0110},  {0.0160, 0.0104},  {0.0235, 0.0118}};
const FaceCurve kUnderLip = {{-0.0085, -0.0055}, {0, -0.0064}, {0.0085, -0.0055}};
const FaceCurve kUnderNose = {{-0.0160, 0.0400}, {-0.0130, 0.0365}, {-0.0080, 0.0375}, {0, 0.0350},
                              {0.0080, 0.0375},  {0.0130, 0.0365},  {0.0160, 0.0400}};
const FaceCurve kLid = {
    {0.0175, 0.0715}, {0.0240, 0.0697}, {0.0315, 0.0688}, {0.0390, 0.0695}, {0.0460, 0.0722}};
const FaceCurve kBrow = {{0.0150, 0.0895}, {0.0260, 0.0935}, {0.0380, 0.0935}, {0.0500, 0.0875}};

FaceCurve Mirrored(const FaceCurve& curve) {
  FaceCurve other;
  for (const Vector2d& p : curve) other.emplace_back(-p.x(), p.y());
  return other;
}

// Through all points of `curve` (Catmull and Rom, 1974).
FaceCurve Rounded(const FaceCurve& curve) {
  constexpr int kPieces = 8;
  FaceCurve round;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const Vector2d& b = curve[i];
    const Vector2d& c = curve[i + 1];
    const Vector2d a = i > 0 ? curve[i - 1] : Vector2d(2 * b - c);
    const Vector2d d = i + 2 < curve.size() ? curve[i + 2] : Vector2d(2 * c - b);
    for (int piece = 0; piece < kPieces; ++piece) {
      const double t = static_cast<double>(piece) / kPieces;
      round.emplace_back(0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                                t * t * t * (3 * b - a - 3 * c + d)));
    }
  }
  round.push_back(curve.back());
  return round;
}

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Shares of the triangle's corners in the point at `p`, as seen from the front; nullopt beside it.
std::optional<Vector3d> SharesAt(const Vector2d& p, const std::array<Vector3d, 3>& corners) {
  std::array<Vector2d, 3> away;
  for (std::size_t i = 0; i < 3; ++i) away[i] = corners[i].tail<2>() - p;
  const Vector3d areas(Cross(away[1], away[2]), Cross(away[2], away[0]), Cross(away[0], away[1]));
  if (!(areas.minCoeff() >= 0) || !(areas.sum() > 0)) return std::nullopt;
  return Vector3d(areas / areas.sum());
}

}  // namespace

FaceLines::FaceLines(const skin::SkinTemplate& skin, const skin::Build& build) {
  const double size = 1 + 0.045 * build.woman;  // as urdf/skin/make has it
  const urdf::Pose head = skin::BindPoseOf(urdf::DefaultSkeleton()).links[urdf::kHead];
  std::vector<Vector3d> in_head;
  for (const Vector3f& p : skin.Blend(build)) {
    in_head.emplace_back(skin::InLink(head, p.cast<double>()) / size);
  }
  const auto is_of_face = [&](const skin::Triangle& triangle) {
    constexpr double kChin = -0.03, kForehead = 0.12, kEars = 0.04;  // m
    const Vector3d& p = in_head[triangle[0]];
    return p.z() > kChin && p.z() < kForehead && p.x() > kEars;
  };
  std::vector<skin::Triangle> face;
  for (const skin::Triangle& triangle : skin.triangles) {
    if (is_of_face(triangle)) face.push_back(triangle);
  }
  const auto foremost = [&](const Vector2d& at) {
    std::optional<PointOnTriangle> found;
    double farthest = 0;
    for (const skin::Triangle& t : face) {
      const auto shares = SharesAt(at, {in_head[t[0]], in_head[t[1]], in_head[t[2]]});
      if (!shares) continue;
      const double x =
          shares->dot(Vector3d(in_head[t[0]].x(), in_head[t[1]].x(), in_head[t[2]].x()));
      if (found && x <= farthest) continue;
      found = {t, shares->cast<float>()};
      farthest = x;
    }
    return found;
  };
  for (const FaceCurve& curve :
       {kMouth, kUnderLip, kUnderNose, kLid, Mirrored(kLid), kBrow, Mirrored(kBrow)}) {
    std::vector<PointOnTriangle> line;
    for (const Vector2d& at : Rounded(curve)) {
      if (const auto point = foremost(at)) line.push_back(*point);
    }
    if (line.size() > 1) lines_.push_back(std::move(line));
  }
}

std::vector<SurfaceLine> FaceLines::On(const std::vector<Vector3f>& positions) const {
  std::vector<SurfaceLine> lines;
  for (const auto& line : lines_) {
    SurfaceLine posed;
    for (const auto& [triangle, shares] : line) {
      posed.points.emplace_back(shares[0] * positions[triangle[0]] +
                                shares[1] * positions[triangle[1]] +
                                shares[2] * positions[triangle[2]]);
    }
    lines.push_back(std::move(posed));
  }
  return lines;
}

}  // namespace kinescope::render
