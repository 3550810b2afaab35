/// Building blocks of the body's rest shape: signed functions of solids. A value is negative
/// inside, positive outside, and close to the distance in metres near the surface. Only + - * / and
/// square roots are used, which IEEE 754 defines to the last bit: every machine makes the same
/// body. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace kinescope::skin {

using Point = Eigen::Vector3d;

/// 0 up to `from`, 1 beyond `to`, smooth between them. `from` may be greater than `to`.
inline double Ramp(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// 1 at 0, a quarter at `width`, 0 far away.
inline double Bump(double x, double width) {
  const double s = 1 + x * x / (width * width);
  return 1 / (s * s);
}

inline double Mix(double a, double b, double share) { return a + (b - a) * share; }

/// The smaller of both; where they differ by less than `width`, rounded (at most width / 6 lower).
/// Its second derivative is continuous, so that no line shows in highlights.
inline double SmoothMin(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * h * width / 6;
}
inline double SmoothMax(double a, double b, double width) { return -SmoothMin(-a, -b, width); }

/// A cone with rounded ends: the sphere `start_radius` at `start`, growing evenly to `end`.
double RoundCone(const Point& p, const Point& start, const Point& end, double start_radius,
                 double end_radius);

/// `radii` along the columns of `axes`.
double Ellipsoid(const Point& p, const Point& center, const Point& radii);
double Ellipsoid(const Point& p, const Point& center, const Point& radii,
                 const Eigen::Matrix3d& axes);

/// Axes whose third column is along `along` and whose first is as near to `towards` as possible.
Eigen::Matrix3d AxesAlong(const Point& along, const Point& towards);

/// A cross-section: how far the surface is from the centre along +u, -u, +v and -v, m. `fullness` 0
/// is an ellipse, 1 a rounded box.
struct CrossSection {
  double at = 0;  // along the axis, m
  double plus_u = 0, minus_u = 0, plus_v = 0, minus_v = 0;
  double center_u = 0, center_v = 0;
  double fullness = 0;
};

/// Cross-sections along a straight axis, interpolated smoothly, with rounded ends.
class Loft {
 public:
  /// @pre at least two sections, `at` ascending. `start_cap`, `end_cap`: lengths of the ends, m.
  Loft(std::vector<CrossSection> sections, double start_cap, double end_cap);

  double operator()(double u, double v, double at) const;

 private:
  CrossSection At(double at) const;

  std::vector<CrossSection> sections_;
  double start_cap_, end_cap_;
};

}  // namespace kinescope::skin
