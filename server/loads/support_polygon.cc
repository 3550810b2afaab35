#include "server/loads/support_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/check.h"
#include "server/loads/inverse_dynamics.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Nearest point on the segment from `a` to `b`.
Vector2d NearestOn(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  const Vector2d along = b - a;
  const double square = along.squaredNorm();
  if (square == 0) return a;
  return a + std::clamp((point - a).dot(along) / square, 0.0, 1.0) * along;
}

struct Border {
  Vector2d nearest;
  bool is_inside;
};

Border Locate(const SupportPolygon& polygon, const Vector2d& point) {
  KINESCOPE_CHECK(polygon.size > 0);
  Border border{polygon.corners[0], polygon.size > 2};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector2d& a = polygon.corners[i];
    const Vector2d& b = polygon.corners[(i + 1) % polygon.size];
    const Vector2d nearest = NearestOn(a, b, point);
    const double distance = (point - nearest).squaredNorm();
    if (distance < least) {
      least = distance;
      border.nearest = nearest;
    }
    if (Cross(b - a, point - a) < 0) border.is_inside = false;  // corners are counter-clockwise
  }
  return border;
}

}  // namespace

SupportPolygon ConvexHull(std::array<Vector2d, kMaxSupportPoints> points, std::size_t count) {
  const auto end = points.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(points.begin(), end, [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  count = static_cast<std::size_t>(std::unique(points.begin(), end) - points.begin());
  SupportPolygon hull;
  if (count < 3) {
    std::copy_n(points.begin(), count, hull.corners.begin());
    hull.size = count;
    return hull;
  }
  // The lower chain from left to right, then the upper one back. The stack may contain every point,
  // and the first one twice.
  std::array<Vector2d, kMaxSupportPoints + 1> chain;
  std::size_t size = 0;
  const auto add = [&](const Vector2d& point, std::size_t bottom) {
    while (size >= bottom + 2 &&
           Cross(chain[size - 1] - chain[size - 2], point - chain[size - 1]) <= 0) {
      --size;
    }
    chain[size++] = point;
  };
  for (std::size_t i = 0; i < count; ++i) add(points[i], 0);
  const std::size_t upper = size - 1;
  for (std::size_t i = count - 1; i-- > 0;) add(points[i], upper);
  hull.size = size - 1;  // the last is the first
  std::copy_n(chain.begin(), hull.size, hull.corners.begin());
  return hull;
}

double DistanceInside(const SupportPolygon& polygon, const Vector2d& point) {
  const Border border = Locate(polygon, point);
  const double distance = (point - border.nearest).norm();
  return border.is_inside ? distance : -distance;
}

Vector2d ClampInto(const SupportPolygon& polygon, const Vector2d& point) {
  const Border border = Locate(polygon, point);
  return border.is_inside ? point : border.nearest;
}

Vector2d ExtrapolatedCenterOfMass(const Vector3d& com, const Vector3d& com_velocity,
                                  double floor_z) {
  const double height = std::max(com.z() - floor_z, 0.0);
  return com.head<2>() + com_velocity.head<2>() * std::sqrt(height / kGravity);
}

}  // namespace kinescope::loads
