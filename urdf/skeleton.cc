#include "urdf/skeleton.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "urdf/kinematics.h"
#include "urdf/landmarks.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

constexpr std::array<int, 2> kShoulder = {kRightShoulder, kLeftShoulder};
constexpr std::array<int, 2> kHand = {kRightHand, kLeftHand};
constexpr std::array<int, 2> kFoot = {kRightFoot, kLeftFoot};
constexpr std::array<int, 2> kToe = {kRightToe, kLeftToe};
constexpr std::array<const char*, 2> kSideName = {"Right", "Left"};

// A vector of a segment frame, in the link frame of the same segment.
Vector3d ToLink(int segment, const Vector3d& in_segment) {
  return SegmentFromLink(segment).conjugate() * in_segment;
}

// Where a joint is in its parent, by either of its names.
std::optional<Vector3d> FindJointPoint(const Landmarks& landmarks, int joint) {
  std::string name(kJoints[At(joint)].mvn_name);
  auto offset = FindLandmark(landmarks, ParentOf(joint), name);
  if (!offset && (joint == jRightC7Shoulder || joint == jLeftC7Shoulder)) {
    name.replace(name.find("C7"), 2, "T4");  // its name in files since MVN 2018
    offset = FindLandmark(landmarks, ParentOf(joint), name);
  }
  return offset;
}

// Fractions of stature for end points without measurements: joint-loads.md 1.6.
constexpr double kHeadFraction = 0.108;
constexpr double kHandFraction = 0.108;
constexpr double kAnkleHeightFraction = 0.046;
constexpr double kHeelFraction = 0.026;
constexpr double kToeFraction = 0.04;

// Standing height from the sole to the crown, along the chain of the spine and the right leg.
double HeightOf(const Skeleton& skeleton) {
  double height = skeleton.head_top_in_head.z() - skeleton.heel_in_foot[kRight].z();
  for (const int segment : {kL5, kL3, kT12, kT8, kNeck, kHead}) {
    height += skeleton.origin_in_parent[At(segment)].z();
  }
  for (const int segment : {kRightUpperLeg, kRightLowerLeg, kRightFoot}) {
    height -= skeleton.origin_in_parent[At(segment)].z();
  }
  return height;
}

// The stature of a skeleton whose end points are still zero, as far as they can be known: all but
// the head, or all but head and soles, is measured.
double GuessHeight(const Skeleton& skeleton, std::optional<double> ankle_height) {
  const double measured = HeightOf(skeleton);  // ankle to C1
  return ankle_height ? (measured + *ankle_height) / (1 - kHeadFraction)
                      : measured / (1 - kHeadFraction - kAnkleHeightFraction);
}

// Half to double the usual: else the pose does not stand on z = 0.
bool IsAnkleHeight(double height, double stature) {
  return height > 0.5 * kAnkleHeightFraction * stature &&
         height < 2 * kAnkleHeightFraction * stature;
}

// Ratios of end points to the bone beside them: the means of the skeletons of two people that MVN
// has written (MVN Studio 4.2.4, MVN 2019) and of the reference skeleton, which differ from them by
// at most 5 % at the head, 1 % at the hand, 7 % at the height of the ball, 20 % at heel and toe.
constexpr double kHeadOfNeck = 1.97;
constexpr double kHandOfForearm = 0.753;
constexpr double kBallHeightOfFoot = 0.10;  // of the distance from the ankle forward to the ball
constexpr double kHeelOfFoot = 0.28;
constexpr double kToeOfFoot = 0.44;

// `ratio` of a bone of `length`, if that is a human length; else `fraction` of the stature.
double EndLength(double length, double ratio, double fraction, double stature) {
  const double usual = fraction / ratio * stature;
  const bool is_human = length > 0.6 * usual && length < 1.6 * usual;
  return is_human ? ratio * length : fraction * stature;
}

// Fills the end points from landmarks, else from the bones beside them; joints must be set.
// `ankle_above_floor`: in the T-pose, where there is one.
class EndPoints {
 public:
  EndPoints(const Landmarks& landmarks, std::optional<double> ankle_above_floor, Skeleton& skeleton)
      : landmarks_(landmarks), skeleton_(skeleton) {
    if (ankle_above_floor && IsAnkleHeight(*ankle_above_floor, GuessHeight(skeleton, {}))) {
      ankle_above_floor_ = ankle_above_floor;
    }
    stature_ = GuessHeight(skeleton, ankle_above_floor_);
  }

  void Set() {
    const double neck = skeleton_.origin_in_parent[kHead].norm();
    skeleton_.head_top_in_head = Find(
        kHead, "pTopOfHead", Vector3d(0, 0, EndLength(neck, kHeadOfNeck, kHeadFraction, stature_)));
    for (const Side side : {kRight, kLeft}) SetLimbs(side);
    skeleton_.height = HeightOf(skeleton_);
  }

 private:
  Vector3d Find(int segment, const std::string& name, const Vector3d& estimate) {
    const auto found = FindLandmark(landmarks_, segment, name);
    if (!found) skeleton_.ends_are_estimated = true;
    return found.value_or(estimate);
  }

  void SetLimbs(Side side) {
    const std::string prefix = std::string("p") + kSideName[side];
    const double forearm = skeleton_.origin_in_parent[At(kHand[side])].norm();
    skeleton_.finger_tip_in_hand[side] =
        Find(kHand[side], prefix + "TopOfHand",
             Vector3d(0, 0, -EndLength(forearm, kHandOfForearm, kHandFraction, stature_)));
    const Vector3d& ball = skeleton_.origin_in_parent[At(kToe[side])];
    const double heel = EndLength(ball.x(), kHeelOfFoot, kHeelFraction, stature_);
    skeleton_.heel_in_foot[side] =
        Find(kFoot[side], prefix + "HeelFoot", Vector3d(-heel, 0, -AnkleHeight(ball)));
    const double ball_above_sole = std::max(0.0, ball.z() - skeleton_.heel_in_foot[side].z());
    const double toe = EndLength(ball.x(), kToeOfFoot, kToeFraction, stature_);
    skeleton_.toe_tip_in_toe[side] =
        Find(kToe[side], prefix + "Toe", Vector3d(toe, 0, -ball_above_sole));
  }

  double AnkleHeight(const Vector3d& ball) const {
    if (ankle_above_floor_) return *ankle_above_floor_;
    const double of_foot = kBallHeightOfFoot * ball.x() - ball.z();
    return IsAnkleHeight(of_foot, stature_) ? of_foot : kAnkleHeightFraction * stature_;
  }

  const Landmarks& landmarks_;
  std::optional<double> ankle_above_floor_;
  double stature_ = 0;
  Skeleton& skeleton_;
};

}  // namespace

bool Skeleton::operator==(const Skeleton& other) const {
  return origin_in_parent == other.origin_in_parent && head_top_in_head == other.head_top_in_head &&
         finger_tip_in_hand == other.finger_tip_in_hand && heel_in_foot == other.heel_in_foot &&
         toe_tip_in_toe == other.toe_tip_in_toe && height == other.height &&
         ends_are_estimated == other.ends_are_estimated;
}

Skeleton DefaultSkeleton(double height_m) {
  // R75, joint-loads.md 6.1: stature 1.750 m.
  Skeleton skeleton;
  auto& origin = skeleton.origin_in_parent;
  origin[kPelvis] = {0, 0, 0};
  origin[kL5] = {0, 0, 0.108};
  origin[kL3] = {0, 0, 0.090};
  origin[kT12] = {0, 0, 0.081};
  origin[kT8] = {0, 0, 0.081};
  origin[kNeck] = {0, 0, 0.116};
  origin[kHead] = {0, 0, 0.094};
  skeleton.head_top_in_head = {0, 0, 0.190};
  for (const Side side : {kRight, kLeft}) {
    const double left = side == kLeft ? 1 : -1;  // y points left
    const int shoulder = kShoulder[side];
    const int foot = kFoot[side];
    origin[At(shoulder)] = {0, left * 0.030, 0.066};
    origin[At(shoulder + 1)] = {0, left * 0.150, 0};
    origin[At(shoulder + 2)] = {0, 0, -0.300};
    origin[At(shoulder + 3)] = {0, 0, -0.250};
    origin[At(foot - 2)] = {0, left * 0.085, 0};
    origin[At(foot - 1)] = {0, 0, -0.465};
    origin[At(foot)] = {0, 0, -0.445};
    origin[At(foot + 1)] = {0.150, 0, -0.064};
    skeleton.finger_tip_in_hand[side] = {0, 0, -0.190};
    skeleton.heel_in_foot[side] = {-0.045, 0, -0.080};
    skeleton.toe_tip_in_toe[side] = {0.070, 0, -0.016};
  }
  const double scale = height_m / kReferenceHeight;
  for (Vector3d& offset : origin) offset *= scale;
  skeleton.head_top_in_head *= scale;
  for (const Side side : {kRight, kLeft}) {
    skeleton.finger_tip_in_hand[side] *= scale;
    skeleton.heel_in_foot[side] *= scale;
    skeleton.toe_tip_in_toe[side] *= scale;
  }
  skeleton.height = height_m;
  return skeleton;
}

Skeleton SkeletonFromTPose(const std::array<Vector3d, kSegmentCount>& origin_in_world,
                           const Landmarks& landmarks) {
  Skeleton skeleton;
  for (int segment = 1; segment < kSegmentCount; ++segment) {
    const int parent = kSegments[At(segment)].parent;
    const Vector3d in_t_pose =
        ToLink(parent, origin_in_world[At(segment)] - origin_in_world[At(parent)]);
    constexpr double kFarthest = 0.03;  // m; a point farther off is another joint's
    const auto joint = FindJointPoint(landmarks, segment - 1);
    const bool is_near = joint && (*joint - in_t_pose).norm() < kFarthest;
    skeleton.origin_in_parent[At(segment)] = is_near ? *joint : in_t_pose;
  }
  EndPoints(landmarks, origin_in_world[kRightFoot].z(), skeleton).Set();
  return skeleton;
}

Skeleton SkeletonFromLandmarks(const Landmarks& landmarks) {
  Skeleton skeleton;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int parent = ParentOf(joint);
    const auto offset = FindJointPoint(landmarks, joint);
    if (!offset) {
      throw std::runtime_error("segment " + std::string(kSegments[At(parent)].mvn_name) +
                               " has no point '" + std::string(kJoints[At(joint)].mvn_name) + "'");
    }
    skeleton.origin_in_parent[At(ChildOf(joint))] = *offset;
  }
  EndPoints(landmarks, std::nullopt, skeleton).Set();
  return skeleton;
}

std::array<Vector3d, kSegmentCount> NPoseOrigins(const Skeleton& skeleton) {
  std::array<Vector3d, kSegmentCount> origins;
  origins[kPelvis] = Vector3d::Zero();
  for (int segment = 1; segment < kSegmentCount; ++segment) {
    origins[At(segment)] =
        origins[At(kSegments[At(segment)].parent)] + skeleton.origin_in_parent[At(segment)];
  }
  LinkPoses links;  // all upright, as link frames are in the N-pose
  for (std::size_t i = 0; i < links.size(); ++i) links[i].position = origins[i];
  const double lowest = LowestSolePoint(skeleton, links);
  for (Vector3d& origin : origins) origin.z() -= lowest;
  return origins;
}

Vector3d EndOf(const Skeleton& skeleton, int segment) {
  switch (segment) {
    case kHead: return skeleton.head_top_in_head;
    case kRightHand: return skeleton.finger_tip_in_hand[kRight];
    case kLeftHand: return skeleton.finger_tip_in_hand[kLeft];
    case kRightToe: return skeleton.toe_tip_in_toe[kRight];
    case kLeftToe: return skeleton.toe_tip_in_toe[kLeft];
    default: return skeleton.origin_in_parent[At(segment + 1)];  // the chain's next, by numbering
  }
}

Eigen::Vector3d GripPoint(const Skeleton& skeleton, Side side) {
  constexpr double kGripOfHandLength = 0.42;
  return kGripOfHandLength * skeleton.finger_tip_in_hand[side];
}

}  // namespace kinescope::urdf
