#include "urdf/landmarks.h"

#include <algorithm>
#include <tuple>

namespace kinescope::urdf {
namespace {

void Sort(Landmarks& landmarks) {
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    return std::tie(a.segment, a.number) < std::tie(b.segment, b.number);
  });
}

}  // namespace

std::optional<Eigen::Vector3d> FindLandmark(const Landmarks& landmarks, int segment,
                                            std::string_view name) {
  for (const Landmark& landmark : landmarks) {
    if (landmark.segment != segment || landmark.name != name) continue;
    return SegmentFromLink(segment).conjugate() * landmark.in_segment;
  }
  return std::nullopt;
}

int PointNumberInParent(Joint joint) {
  // The end of the segment is its point 2; T8 and pelvis have more than one end.
  if (joint == jRightC7Shoulder || joint == jRightHip) return 3;
  if (joint == jLeftC7Shoulder || joint == jLeftHip) return 4;
  return 2;
}

Landmarks JointLandmarksOf(const Skeleton& skeleton) {
  Landmarks landmarks = {{kPelvis, 1, "pHipOrigin"}};
  for (int i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    const int parent = ParentOf(joint), child = ChildOf(joint);
    const std::string name(kJoints[At(joint)].mvn_name);
    landmarks.push_back({parent, PointNumberInParent(joint), name,
                         SegmentFromLink(parent) * skeleton.origin_in_parent[At(child)]});
    landmarks.push_back({child, 1, name});
  }
  Sort(landmarks);
  return landmarks;
}

Landmarks LandmarksOf(const Skeleton& skeleton) {
  Landmarks landmarks = JointLandmarksOf(skeleton);
  const auto add = [&landmarks](int segment, int number, std::string name,
                                const Eigen::Vector3d& in_link) {
    landmarks.push_back({segment, number, std::move(name), SegmentFromLink(segment) * in_link});
  };
  add(kHead, 2, "pTopOfHead", skeleton.head_top_in_head);
  for (const Side side : {kRight, kLeft}) {
    const bool is_right = side == kRight;
    const std::string prefix = is_right ? "pRight" : "pLeft";
    add(HandSegmentOf(side), 2, prefix + "TopOfHand", skeleton.finger_tip_in_hand[side]);
    add(FootSegmentOf(side), 3, prefix + "HeelFoot", skeleton.heel_in_foot[side]);
    add(is_right ? kRightToe : kLeftToe, 2, prefix + "Toe", skeleton.toe_tip_in_toe[side]);
  }
  Sort(landmarks);
  return landmarks;
}

}  // namespace kinescope::urdf
