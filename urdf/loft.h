/// Builds closed surfaces through cross-sections (lofts), from which the body model is made. Any
/// thread; an object belongs to one thread at a time.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "urdf/body_surface.h"

namespace kinescope::urdf {

/// A cross-section: a superellipse with a separate half-width on each of four sides, in the plane
/// of two directions u and v. Metres.
struct Section {
  enum Field { kPlusU, kMinusU, kPlusV, kMinusV, kCenterU, kCenterV, kPowerPlusU, kPowerMinusU };
  double at = 0;  // position along the axis
  Eigen::Matrix<double, 8, 1> shape = Eigen::Matrix<double, 8, 1>::Zero();

  Section& Center(double u, double v);
  /// Exponents of the halves towards +u and -u: 2 is an ellipse, larger values approach a box.
  Section& Power(double plus_u, double minus_u);
};

/// Half-widths towards +u, -u, +v, -v, m.
Section Widths(double at, double plus_u, double minus_u, double plus_v, double minus_v);

/// Cross-sections with a smooth transition between them. @pre two or more, in ascending order of
/// `at`
class Profile {
 public:
  explicit Profile(std::vector<Section> sections) : sections_(std::move(sections)) {}
  /// This profile with each section widened towards +v and -v by its `factor`.
  Profile Widened(const std::function<double(double at)>& factor) const;
  /// This profile with each section and its centre raised in u by its `factor`.
  Profile Raised(const std::function<double(double at)>& factor) const;
  /// Constant before the first and after the last.
  Eigen::Matrix<double, 8, 1> At(double at) const;

 private:
  std::vector<Section> sections_;
};

/// A smooth line through points: the first is at 0, the next at 1, and so on; it continues straight
/// beyond both ends.
class Curve {
 public:
  explicit Curve(std::vector<Eigen::Vector3d> points);  // @pre two or more
  Eigen::Vector3d At(double at) const;
  Eigen::Vector3d Tangent(double at) const;  // derivative of At

 private:
  Eigen::Vector3d TangentOf(std::size_t point) const;
  std::vector<Eigen::Vector3d> points_;
};

/// Placement of a profile: the centre of the section `at` lies on `line`, in the plane of the unit
/// vectors u and v, enlarged by `scale`.
struct LoftAxis {
  Curve line;
  Eigen::Vector3d u, v;
  double scale = 1;
  /// Displacement of a point of the surface that belongs to the section `at`, m; empty: none. It
  /// must be smooth, and small compared with the section.
  std::function<Eigen::Vector3d(const Eigen::Vector3d& point, double at)> relief = {};
};

struct LoftRange {
  double from = 0, to = 1;             // part of the profile
  double start_cap = 0, end_cap = 0;   // length of the rounded ends beyond the range, m before
                                       // scaling
  int points = 18;                     // per section
  int rings = 8;                       // along the axis, without the caps
  int start_rings = 4, end_rings = 4;  // per cap, 1 or more
  /// The outline continues in a neighbour with the same profile and line, which rotates about this
  /// end. There the cap begins as a circle in every direction, as that of the neighbour does.
  /// However they rotate, both lie on the same arc and no step is visible. The length of the cap is
  /// that of its pole.
  bool start_runs_on = false, end_runs_on = false;
  double crowd_u = 0;  // 0..1: puts more of the points on the +u side
};

/// Adds one closed shell, facing outward. Normals are those of the smooth surface, so that two
/// shells with a common surface are shaded alike where they meet.
void AddLoft(const LoftAxis& axis, const Profile& profile, const LoftRange& range,
             TriangleMesh& mesh);

/// Recomputes the normals of all vertices after the surface was moved: the mean of the adjacent
/// triangles' normals, weighted by area.
void ComputeNormals(TriangleMesh& mesh);

}  // namespace kinescope::urdf
