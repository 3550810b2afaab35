#include "urdf/mesh_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "urdf/loft.h"

namespace kinescope::urdf {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

bool IsArm(int segment) {
  return (segment >= kRightUpperArm && segment <= kRightHand) ||
         (segment >= kLeftUpperArm && segment <= kLeftHand);
}

bool IsFoot(int segment) { return segment == kRightFoot || segment == kLeftFoot; }
bool IsToe(int segment) { return segment == kRightToe || segment == kLeftToe; }

void Transform(const Eigen::Affine3d& to_from_mesh, TriangleMesh& mesh) {
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = (to_from_mesh * vertex.cast<double>()).cast<float>();
  }
  ComputeNormals(mesh);
}

struct Span {
  double from, to;  // m along an axis of the link, from its origin
  double length() const { return to - from; }
  double middle() const { return 0.5 * (from + to); }
};

// The axis of the link that the segment mostly runs along, and which way.
struct Direction {
  int axis;
  double sign;
};

Direction DirectionOf(const Skeleton& skeleton, int segment) {
  Direction direction{};
  const Vector3d end = EndOf(skeleton, segment);
  end.cwiseAbs().maxCoeff(&direction.axis);
  direction.sign = end[direction.axis] < 0 ? -1 : 1;
  return direction;
}

Span SpanOf(const AlignedBox3d& box, const Direction& along) {
  const double low = along.sign * box.min()[along.axis];
  const double high = along.sign * box.max()[along.axis];
  return {std::min(low, high), std::max(low, high)};
}

// Where the segment begins and ends. Those that reach behind their joint do so as the built-in
// surface.
Span OwnSpan(const Skeleton& skeleton, int segment, const Direction& along) {
  Span span = {0, along.sign * EndOf(skeleton, segment)[along.axis]};
  if (segment == kPelvis || segment == kHead || IsFoot(segment)) {
    span.from = SpanOf(BoundsOf(SegmentMesh(skeleton, segment)), along).from;
  }
  return span;
}

// A foot stands on the floor: what is lowest of it lies on the sole.
void PutOnSole(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const Side side = segment == kRightFoot || segment == kRightToe ? kRight : kLeft;
  const double sole =
      IsFoot(segment) ? skeleton.heel_in_foot[side].z() : skeleton.toe_tip_in_toe[side].z();
  const double lowest = BoundsOf(mesh).min().z();
  Transform(Eigen::Affine3d(Eigen::Translation3d(0, 0, sole - lowest)), mesh);
}

}  // namespace

AlignedBox3d BoundsOf(const TriangleMesh& mesh) {
  AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  return box;
}

TriangleMesh ToLinkFrame(TriangleMesh mesh, const MeshConvention& convention, int segment) {
  Eigen::Affine3d link_from_mesh = Eigen::Affine3d::Identity();
  link_from_mesh.scale(convention.metres_per_unit);
  if (convention.y_is_up) link_from_mesh.rotate(Eigen::AngleAxisd(M_PI_2, Vector3d::UnitX()));
  Transform(link_from_mesh, mesh);
  if (!IsArm(segment) || mesh.vertices.empty()) return mesh;
  const Vector3d size = BoundsOf(mesh).sizes();
  const bool is_t_pose =
      convention.frame == MeshConvention::Frame::kSegment ||
      (convention.frame == MeshConvention::Frame::kLonger && size.y() > size.z());
  if (is_t_pose) Transform(Eigen::Affine3d(SegmentFromLink(segment).conjugate()), mesh);
  return mesh;
}

TriangleMesh FitToPerson(TriangleMesh mesh, const Skeleton& skeleton, int segment) {
  if (mesh.vertices.empty()) return mesh;
  const Direction along = DirectionOf(skeleton, segment);
  const Span has = SpanOf(BoundsOf(mesh), along);
  const Span wants = OwnSpan(skeleton, segment, along);
  // Nothing of a skeleton or a mesh is trusted to have a length.
  constexpr double kShortest = 1e-3;
  constexpr double kMaxStretch = 5;
  const auto ratio = [&](double wanted, double is) {
    return std::clamp(wanted / std::max(is, kShortest), 1 / kMaxStretch, kMaxStretch);
  };
  constexpr double kOffMiddle = 0.3;  // of half the length
  const bool is_about_middle = has.middle() < kOffMiddle * 0.5 * has.length();
  const double stretch =
      is_about_middle ? ratio(wants.length(), has.length()) : ratio(wants.to, has.to);
  const double shift = is_about_middle ? wants.middle() - stretch * has.middle() : 0;

  Vector3d scale = Vector3d::Ones();
  Vector3d translation = Vector3d::Zero();
  scale[along.axis] = stretch;
  translation[along.axis] = along.sign * shift;
  Transform(Eigen::Translation3d(translation) * Eigen::Scaling(scale), mesh);
  if (IsFoot(segment) || IsToe(segment)) PutOnSole(skeleton, segment, mesh);
  return mesh;
}

}  // namespace kinescope::urdf
