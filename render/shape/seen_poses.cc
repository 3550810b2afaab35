#include "render/shape/seen_poses.h"

#include <cmath>

#include "urdf/segments.h"

namespace kinescope::render {
namespace {

// Degrees, of both sides.
struct Bends {
  double back = 0;                  // forwards, at each joint
  double girdle = 0, abducted = 0;  // of the shoulder, upwards
  double raised = 0;                // of the upper arm, forwards
  double elbow = 0, hip = 0, knee = 0;
};

urdf::LinkPoses PosesOf(const urdf::Skeleton& skeleton, const Bends& bends) {
  constexpr double kDegree = M_PI / 180;
  urdf::JointAngles angles{};
  for (const int joint : {urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8, urdf::jT1C7}) {
    angles[urdf::At(joint)].y() = kDegree * bends.back;
  }
  const auto set = [&](int right, int left, double outwards, double y) {
    angles[urdf::At(right)] = kDegree * Eigen::Vector3d(-outwards, y, 0);
    angles[urdf::At(left)] = kDegree * Eigen::Vector3d(outwards, y, 0);
  };
  set(urdf::jRightC7Shoulder, urdf::jLeftC7Shoulder, bends.girdle, 0);
  set(urdf::jRightShoulder, urdf::jLeftShoulder, bends.abducted, -bends.raised);
  set(urdf::jRightElbow, urdf::jLeftElbow, 0, -bends.elbow);
  set(urdf::jRightHip, urdf::jLeftHip, 0, -bends.hip);
  set(urdf::jRightKnee, urdf::jLeftKnee, 0, bends.knee);
  return urdf::ForwardKinematics(skeleton, {}, angles);
}

}  // namespace

std::vector<urdf::LinkPoses> SeenPoses(const urdf::Skeleton& skeleton) {
  Bends work, n_pose, t_pose, overhead, folded;
  work.back = folded.back = 10;
  work.raised = 50;
  work.elbow = 80;
  work.hip = 70;
  work.knee = 90;
  t_pose.abducted = 90;
  overhead.girdle = 22;
  overhead.abducted = 143;
  folded.abducted = 10;
  folded.raised = 80;
  folded.elbow = 140;
  folded.hip = 118;
  folded.knee = 135;
  std::vector<urdf::LinkPoses> poses;
  for (const Bends& bends : {work, n_pose, t_pose, overhead, folded}) {
    poses.push_back(PosesOf(skeleton, bends));
  }
  return poses;
}

}  // namespace kinescope::render
