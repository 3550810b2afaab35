#include "urdf/skin/make/solid.h"

#include <Eigen/Geometry>
#include <utility>

namespace kinescope::skin {

double RoundCone(const Point& p, const Point& start, const Point& end, double start_radius,
                 double end_radius) {
  const Point bone = end - start, from_start = p - start;
  const double t = std::clamp(from_start.dot(bone) / bone.squaredNorm(), 0.0, 1.0);
  return (from_start - t * bone).norm() - Mix(start_radius, end_radius, t);
}

// The value of the unit sphere in stretched space, divided by its gradient.
double Ellipsoid(const Point& p, const Point& center, const Point& radii) {
  const Point unit = (p - center).cwiseQuotient(radii);
  const double distance = unit.norm();
  const double gradient = unit.cwiseQuotient(radii).norm();
  if (gradient < 1e-6) return -radii.minCoeff();
  return distance * (distance - 1) / gradient;
}

double Ellipsoid(const Point& p, const Point& center, const Point& radii,
                 const Eigen::Matrix3d& axes) {
  return Ellipsoid(axes.transpose() * (p - center), Point::Zero(), radii);
}

Eigen::Matrix3d AxesAlong(const Point& along, const Point& towards) {
  Eigen::Matrix3d axes;
  axes.col(2) = along.normalized();
  axes.col(0) = (towards - towards.dot(axes.col(2)) * axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Loft::Loft(std::vector<CrossSection> sections, double start_cap, double end_cap)
    : sections_(std::move(sections)), start_cap_(start_cap), end_cap_(end_cap) {}

// Cubic Hermite curves through the sections. The ends are flat, because the caps begin there.
CrossSection Loft::At(double at) const {
  if (at <= sections_.front().at) return sections_.front();
  if (at >= sections_.back().at) return sections_.back();
  std::size_t i = 1;
  while (sections_[i].at < at) ++i;
  const CrossSection& a = sections_[i - 1];
  const CrossSection& b = sections_[i];
  const double length = b.at - a.at, t = (at - a.at) / length, t2 = t * t, t3 = t2 * t;
  const auto value = [&](double CrossSection::*of) {
    const double slope_a =
        i > 1 ? (b.*of - sections_[i - 2].*of) / (b.at - sections_[i - 2].at) : 0;
    const double slope_b = i + 1 < sections_.size()
                               ? (sections_[i + 1].*of - a.*of) / (sections_[i + 1].at - a.at)
                               : 0;
    return (2 * t3 - 3 * t2 + 1) * (a.*of) + (t3 - 2 * t2 + t) * length * slope_a +
           (3 * t2 - 2 * t3) * (b.*of) + (t3 - t2) * length * slope_b;
  };
  using S = CrossSection;
  return {at,
          value(&S::plus_u),
          value(&S::minus_u),
          value(&S::plus_v),
          value(&S::minus_v),
          value(&S::center_u),
          value(&S::center_v),
          value(&S::fullness)};
}

double Loft::operator()(double u, double v, double at) const {
  const CrossSection section = At(at);
  u -= section.center_u;
  v -= section.center_v;
  const double radius_u = u > 0 ? section.plus_u : section.minus_u;
  const double radius_v = v > 0 ? section.plus_v : section.minus_v;
  const double x = u / radius_u, y = v / radius_v;
  // Between the circle's norm and the fourth-power norm, which is that of a rounded box.
  const double round = std::sqrt(x * x + y * y);
  const double full = std::sqrt(std::sqrt(x * x * x * x + y * y * y * y));
  const double across = Mix(round, full, section.fullness);
  const double beyond =
      std::max({sections_.front().at - at, at - sections_.back().at, 0.0});  // into a cap
  const double z = beyond / (at < sections_.front().at ? start_cap_ : end_cap_);
  const double scale = std::sqrt(across * across + z * z);
  if (scale < 1e-6) return -std::min(radius_u, radius_v);
  return (scale - 1) * std::sqrt(u * u + v * v + beyond * beyond) / scale;
}

}  // namespace kinescope::skin
