/// Computes the support polygon and the margin of stability of a standing person. Pure functions;
/// horizontal coordinates (x, y) in the world frame, metres. Any thread, no allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/body_forces.h"

namespace kinescope::loads {

/// The convex hull of the first `count` of `points`, counter-clockwise, without points on its
/// edges. Andrew's monotone chain (A. M. Andrew, Information Processing Letters 9, 1979, 216).
SupportPolygon ConvexHull(std::array<Eigen::Vector2d, kMaxSupportPoints> points, std::size_t count);

/// Distance of `point` from the border, m: positive inside, negative outside. For a polygon with
/// one or two points: minus the distance. @pre it is not empty
double DistanceInside(const SupportPolygon& polygon, const Eigen::Vector2d& point);

/// `point`, or the nearest point of the border if it is outside. @pre it is not empty
Eigen::Vector2d ClampInto(const SupportPolygon& polygon, const Eigen::Vector2d& point);

/// The extrapolated centre of mass: where a person who moves like an inverted pendulum would have
/// to step to come to rest. xcom = com + v / sqrt(g / l), l the height of the CoM above the floor;
/// m, m/s. Source: A. L. Hof, M. G. J. Gazendam, W. E. Sinke, The condition for dynamic stability,
/// J. Biomech. 38 (2005) 1-8. The margin of stability is DistanceInside(polygon, xcom).
Eigen::Vector2d ExtrapolatedCenterOfMass(const Eigen::Vector3d& com,
                                         const Eigen::Vector3d& com_velocity, double floor_z);

}  // namespace kinescope::loads
