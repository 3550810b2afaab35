// How sure a pose is, as RViz shows it: one standard deviation, or as many as the style says.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

enum CovarianceId : int { kEllipsoid = 1, kFirstTurn = 2 };  // kFirstTurn + 0, 1, 2

constexpr double kThin = 0.001;  // m, and of the other diameters

// The block of the position (0) or of the orientation (3) of a covariance of 6 by 6.
Matrix3d BlockOf(const geometry_msgs::PoseWithCovariance& pose, std::size_t first) {
  constexpr std::size_t kRow = 6;
  Matrix3d block;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      block(static_cast<int>(i), static_cast<int>(k)) =
          (pose.covariance[kRow * (first + i) + first + k] +
           pose.covariance[kRow * (first + k) + first + i]) /
          2;
    }
  }
  return block;
}

struct Principal {
  Vector3d deviations;  // from the least
  Eigen::Quaterniond axes;
};

// @pre covariance.allFinite()
Principal PrincipalOf(const Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  Matrix3d turn = solver.eigenvectors();
  if (turn.determinant() < 0) turn.col(0) *= -1;
  return {solver.eigenvalues().cwiseMax(0).cwiseSqrt(), Eigen::Quaterniond(turn)};
}

std_msgs::ColorRGBA Tint(const std::optional<Rgb>& color, double alpha,
                         const std_msgs::ColorRGBA& usual) {
  ShownStyle style;
  style.color = color;
  style.alpha = alpha;
  return In(style, usual);
}

// Of the position; flat if z has none.
Marker EllipsoidOf(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                   const CovarianceStyle& style) {
  Matrix3d covariance = BlockOf(pose, 0);
  if (!covariance.allFinite()) return Without(header, kEllipsoid);
  if (covariance(2, 2) <= 0) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  const Principal principal = PrincipalOf(covariance);
  Vector3d diameters = 2 * style.scale * principal.deviations;
  if (!(diameters.maxCoeff() > 0)) return Without(header, kEllipsoid);
  diameters = diameters.cwiseMax(kThin * diameters.maxCoeff());
  Marker ellipsoid = MarkerOf(header, kEllipsoid, Marker::SPHERE,
                              Tint(style.color, style.alpha, Color(204, 51, 204)));
  ellipsoid.pose = PoseAt(PositionOf(pose.pose), principal.axes);
  ellipsoid.scale.x = diameters.x();
  ellipsoid.scale.y = diameters.y();
  ellipsoid.scale.z = diameters.z();
  return ellipsoid;
}

// As far as the tip of an axis of the length 1 goes sideways.
double SidewaysOf(double deviation_rad) {
  constexpr double kMost = 89 * M_PI / 180;
  return std::tan(std::min(deviation_rad, kMost));
}

std_msgs::ColorRGBA TintOfAxis(int axis, const TurnCovarianceStyle& style) {
  if (!style.has_axis_colors) return Tint(style.color, style.alpha, Color(255, 255, 127));
  return Tint({}, style.alpha, ColorOfAxis(axis));
}

// Where the tip of an axis may be: an ellipse about it. A small turn w moves the tip by w x axis.
Marker DiscOf(const std_msgs::Header& header, const geometry_msgs::Pose& pose,
              const Matrix3d& covariance, int axis, const TurnCovarianceStyle& style) {
  const int id = kFirstTurn + axis;
  const Vector3d along = Vector3d::Unit(axis);
  Matrix3d cross;
  for (int i = 0; i < 3; ++i) cross.col(i) = Vector3d::Unit(i).cross(along);
  const Principal principal = PrincipalOf(cross * covariance * cross.transpose());
  // The least is that along the axis: none. The ellipse lies across it.
  const double wide = 2 * style.offset_m * SidewaysOf(style.scale * principal.deviations[2]);
  const double narrow = 2 * style.offset_m * SidewaysOf(style.scale * principal.deviations[1]);
  if (!(wide > 0)) return Without(header, id);
  Matrix3d turn;
  turn.col(0) = principal.axes * Vector3d::UnitZ();
  turn.col(2) = along;
  turn.col(1) = turn.col(2).cross(turn.col(0));
  Marker disc = MarkerOf(header, id, Marker::CYLINDER, TintOfAxis(axis, style));
  const Eigen::Quaterniond of_pose = TurnOf(pose);
  disc.pose = PoseAt(PositionOf(pose) + of_pose * (style.offset_m * along),
                     of_pose * Eigen::Quaterniond(turn));
  disc.scale.x = wide;
  disc.scale.y = std::max(narrow, kThin * wide);
  disc.scale.z = kThin;
  return disc;
}

// Of a pose in the plane: where its x may point.
Marker WedgeOf(const std_msgs::Header& header, const geometry_msgs::Pose& pose, double variance,
               const TurnCovarianceStyle& style) {
  const double side = SidewaysOf(style.scale * std::sqrt(std::max(variance, 0.0)));
  if (!(side > 0)) return Without(header, kFirstTurn);
  Marker wedge = TrianglesOf(header, kFirstTurn, TintOfAxis(2, style));
  wedge.pose = PoseAt(PositionOf(pose), TurnOf(pose));
  const double length = style.offset_m;
  wedge.points = {PointAt(0, 0, 0), PointAt(length, -length * side, 0),
                  PointAt(length, length * side, 0)};
  return wedge;
}

bool IsInPlane(const geometry_msgs::PoseWithCovariance& pose) {
  constexpr std::size_t kZ = 14, kRoll = 21, kPitch = 28;
  return pose.covariance[kZ] <= 0 && pose.covariance[kRoll] <= 0 && pose.covariance[kPitch] <= 0;
}

void AddTurns(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
              const TurnCovarianceStyle& style, ShownMarkers& markers) {
  const Matrix3d covariance = BlockOf(pose, 3);
  const bool is_finite = covariance.allFinite();
  const bool is_in_plane = IsInPlane(pose);
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_finite || (is_in_plane && axis > 0)) {
      markers.push_back(Without(header, kFirstTurn + axis));
    } else if (is_in_plane) {
      markers.push_back(WedgeOf(header, pose.pose, covariance(2, 2), style));
    } else {
      markers.push_back(DiscOf(header, pose.pose, covariance, axis, style));
    }
  }
}

}  // namespace

void AddCovariances(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                    const ShownStyle& style, ShownMarkers& markers) {
  if (style.covariance.scale > 0) markers.push_back(EllipsoidOf(header, pose, style.covariance));
  if (style.turn_covariance.scale > 0) AddTurns(header, pose, style.turn_covariance, markers);
}

}  // namespace kinescope::ros_bridge
