#include "urdf/skeleton.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "urdf/kinematics.h"

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

std::optional<Vector3d> FindLandmark(const Landmarks& landmarks, int segment,
                                     const std::string& name) {
  const auto found = landmarks.find({segment, name});
  if (found == landmarks.end()) return std::nullopt;
  return ToLink(segment, found->second);
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

// Fills the end points from landmarks, else from stature; joints must be set. `ankle_above_floor`:
// in the T-pose, where there is one.
void SetEndPoints(const Landmarks& landmarks, std::optional<double> ankle_above_floor,
                  Skeleton& skeleton) {
  if (ankle_above_floor && !IsAnkleHeight(*ankle_above_floor, GuessHeight(skeleton, {}))) {
    ankle_above_floor.reset();
  }
  const double guessed_height = GuessHeight(skeleton, ankle_above_floor);
  const double ankle_height = ankle_above_floor.value_or(kAnkleHeightFraction * guessed_height);
  skeleton.head_top_in_head = FindLandmark(landmarks, kHead, "pTopOfHead")
                                  .value_or(Vector3d(0, 0, kHeadFraction * guessed_height));
  for (const Side side : {kRight, kLeft}) {
    const std::string prefix = std::string("p") + kSideName[side];
    skeleton.finger_tip_in_hand[side] =
        FindLandmark(landmarks, kHand[side], prefix + "TopOfHand")
            .value_or(Vector3d(0, 0, -kHandFraction * guessed_height));
    skeleton.heel_in_foot[side] =
        FindLandmark(landmarks, kFoot[side], prefix + "HeelFoot")
            .value_or(Vector3d(-kHeelFraction * guessed_height, 0, -ankle_height));
    const double ball_above_sole =
        skeleton.origin_in_parent[At(kToe[side])].z() - skeleton.heel_in_foot[side].z();
    skeleton.toe_tip_in_toe[side] =
        FindLandmark(landmarks, kToe[side], prefix + "Toe")
            .value_or(Vector3d(kToeFraction * guessed_height, 0, -std::max(0.0, ball_above_sole)));
  }
  skeleton.height = HeightOf(skeleton);
}

}  // namespace

bool Skeleton::operator==(const Skeleton& other) const {
  return origin_in_parent == other.origin_in_parent && head_top_in_head == other.head_top_in_head &&
         finger_tip_in_hand == other.finger_tip_in_hand && heel_in_foot == other.heel_in_foot &&
         toe_tip_in_toe == other.toe_tip_in_toe && height == other.height;
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
  SetEndPoints(landmarks, origin_in_world[kRightFoot].z(), skeleton);
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
  SetEndPoints(landmarks, std::nullopt, skeleton);
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
