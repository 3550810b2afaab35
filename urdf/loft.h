/// Closed surfaces lofted through cross-sections: what the figure is made of.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "urdf/figure.h"

namespace kinescope::urdf {

/// A cross-section: a superellipse with its own half-width to each of four sides, in the plane of
/// two directions u and v.
struct Section {
  enum Field { kPlusU, kMinusU, kPlusV, kMinusV, kCenterU, kCenterV, kPowerPlusU, kPowerMinusU };
  double at = 0;  // where along the axis
  Eigen::Matrix<double, 8, 1> shape = Eigen::Matrix<double, 8, 1>::Zero();

  Section& Center(double u, double v);
  /// 2 is an ellipse, more is boxier; for the halves towards +u and -u.
  Section& Power(double plus_u, double minus_u);
};

/// Half-widths towards +u, -u, +v, -v.
Section Widths(double at, double plus_u, double minus_u, double plus_v, double minus_v);

/// Cross-sections with a smooth transition between them. @pre ascending `at`, two or more
class Profile {
 public:
  explicit Profile(std::vector<Section> sections) : sections_(std::move(sections)) {}
  /// The same, as much wider towards both +v and -v as `factor` says at each section.
  Profile Widened(const std::function<double(double at)>& factor) const;
  /// The same, higher in u, its centres too.
  Profile Raised(const std::function<double(double at)>& factor) const;
  /// Constant before the first and after the last.
  Eigen::Matrix<double, 8, 1> At(double at) const;

 private:
  std::vector<Section> sections_;
};

/// A smooth line through points: the first is at 0, the next at 1, and so on; straight beyond both
/// ends.
class Curve {
 public:
  explicit Curve(std::vector<Eigen::Vector3d> points);  // @pre two or more
  Eigen::Vector3d At(double at) const;
  Eigen::Vector3d Tangent(double at) const;  // its derivative

 private:
  Eigen::Vector3d TangentOf(std::size_t point) const;
  std::vector<Eigen::Vector3d> points_;
};

/// Where a profile lives: the middle of the section `at` lies on `line`, the section in the plane
/// of the unit vectors u and v, enlarged by `scale`.
struct LoftAxis {
  Curve line;
  Eigen::Vector3d u, v;
  double scale = 1;
  /// By how much a point of the surface, which belongs to the section `at`, is moved; none:
  /// nothing. Smooth, and small against the section.
  std::function<Eigen::Vector3d(const Eigen::Vector3d& point, double at)> relief = {};
};

struct LoftRange {
  double from = 0, to = 1;             // part of the profile
  double start_cap = 0, end_cap = 0;   // how far the rounded ends go beyond it, m before scaling
  int points = 18;                     // around
  int rings = 8;                       // along, without the caps
  int start_rings = 4, end_rings = 4;  // of the caps, 1 or more
  /// The outline runs on into a neighbour of the same profile and line, which turns about this end.
  /// Seen from there the cap begins as a circle in every direction, as the neighbour's does:
  /// however they turn, both lie on the same arc and no step shows. The cap's length is that of its
  /// pole.
  bool start_runs_on = false, end_runs_on = false;
  double crowd_u = 0;  // 0..1: more of the points are on the +u side
};

/// Adds one closed shell, facing outward. Normals are those of the smooth surface: two shells that
/// share one are shaded alike where they meet.
void AddLoft(const LoftAxis& axis, const Profile& profile, const LoftRange& range,
             TriangleMesh& mesh);

/// Normals of all vertices anew, for a surface that was moved: the mean of the adjacent triangles',
/// weighted by area.
void ComputeNormals(TriangleMesh& mesh);

}  // namespace kinescope::urdf
