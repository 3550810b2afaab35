#include "server/loads/static_loads.h"

#include <algorithm>
#include <cmath>

namespace kinescope::loads {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace urdf;  // segment and joint names

constexpr double kGravity = 9.81;  // m/s^2, as in every reference number

struct Foot {
  Vector2d center;    // midpoint of the ground projections of heel and toe tip
  double weight = 0;  // 0 in the air .. 1 on the floor
};

Foot FootAt(Side side, const LinkPoses& links, const Skeleton& skeleton, double floor_z) {
  const Pose& foot = links[side == kRight ? kRightFoot : kLeftFoot];
  const Pose& toe = links[side == kRight ? kRightToe : kLeftToe];
  const Vector3d heel = foot.position + foot.orientation * skeleton.heel_in_foot[side];
  const Vector3d tip = toe.position + toe.orientation * skeleton.toe_tip_in_toe[side];
  constexpr double kFullBelow = 0.04;  // m above the floor
  constexpr double kNoneAbove = 0.08;
  const double height = std::min({heel.z(), tip.z(), toe.position.z()}) - floor_z;
  const double weight = (kNoneAbove - height) / (kNoneAbove - kFullBelow);
  return {0.5 * (heel + tip).head<2>(), std::clamp(weight, 0.0, 1.0)};
}

struct GroundShare {
  double right = 0.5;  // of the force
  Vector2d cop_right, cop_left;
};

// joint-loads.md 2.6: projects the CoP on the line between the foot centres.
GroundShare Split(const Vector2d& cop, const Foot& right, const Foot& left) {
  const Vector2d apart = right.center - left.center;
  constexpr double kClosest = 0.05;  // m; nearer feet cannot be told apart
  double share = 0.5;
  if (apart.norm() >= kClosest) {
    share = std::clamp((cop - left.center).dot(apart) / apart.squaredNorm(), 0.0, 1.0);
  }
  const double right_part = share * right.weight;
  const double left_part = (1 - share) * left.weight;
  if (right_part + left_part > 0) {
    share = right_part / (right_part + left_part);
  } else {  // the CoP is at a foot that is in the air
    share = right.weight > left.weight ? 1.0 : 0.0;
  }
  const Vector2d offset = cop - ((1 - share) * left.center + share * right.center);
  return {share, right.center + offset, left.center + offset};
}

}  // namespace

const std::array<int, 15> kScoredJoints = {jL5S1,         jT9T8,       jT1C7,      jRightShoulder,
                                           jLeftShoulder, jRightElbow, jLeftElbow, jRightWrist,
                                           jLeftWrist,    jRightHip,   jLeftHip,   jRightKnee,
                                           jLeftKnee,     jRightAnkle, jLeftAnkle};

StaticSolution SolveStatics(const LinkPoses& links, const Skeleton& skeleton,
                            const BodyParameters& body, double floor_z) {
  StaticSolution solution;
  std::array<Vector3d, kSegmentCount> com;
  double mass = 0;
  for (std::size_t i = 0; i < com.size(); ++i) {
    com[i] = links[i].position + links[i].orientation * body[i].com_in_link;
    solution.com += body[i].mass * com[i];
    mass += body[i].mass;
  }
  solution.com /= mass;

  // What the ground does to each segment: force, and moment about the segment's origin.
  std::array<Vector3d, kSegmentCount> ground_force{}, ground_moment{};
  std::fill(ground_force.begin(), ground_force.end(), Vector3d::Zero());
  std::fill(ground_moment.begin(), ground_moment.end(), Vector3d::Zero());
  const Foot right = FootAt(kRight, links, skeleton, floor_z);
  const Foot left = FootAt(kLeft, links, skeleton, floor_z);
  if (right.weight + left.weight > 0) {
    const Vector2d cop = solution.com.head<2>();
    solution.cop = Vector3d(cop.x(), cop.y(), floor_z);
    const GroundShare ground = Split(cop, right, left);
    solution.right_foot_share = ground.right;
    const auto push = [&](int foot, double share, const Vector2d& at) {
      const Vector3d arm = Vector3d(at.x(), at.y(), floor_z) - links[At(foot)].position;
      ground_force[At(foot)] = Vector3d(0, 0, share * mass * kGravity);
      ground_moment[At(foot)] = arm.cross(ground_force[At(foot)]);
    };
    push(kRightFoot, ground.right, ground.cop_right);
    push(kLeftFoot, 1 - ground.right, ground.cop_left);
  }

  // Recursive form of 2.2, leaves first: children have higher numbers than their parents.
  for (std::size_t i = 0; i < com.size(); ++i) {
    solution.force[i] = Vector3d(0, 0, body[i].mass * kGravity) - ground_force[i];
    solution.moment[i] =
        (com[i] - links[i].position).cross(Vector3d(0, 0, body[i].mass * kGravity)) -
        ground_moment[i];
  }
  for (int child = kSegmentCount - 1; child > 0; --child) {
    const int parent = kSegments[At(child)].parent;
    const Vector3d arm = links[At(child)].position - links[At(parent)].position;
    solution.force[At(parent)] += solution.force[At(child)];
    solution.moment[At(parent)] +=
        solution.moment[At(child)] + arm.cross(solution.force[At(child)]);
  }
  return solution;
}

}  // namespace kinescope::loads
