// Moment components (joint-loads.md 2.8) against static strength (4.2).
#include <algorithm>
#include <cmath>

#include "server/loads/static_loads.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using namespace urdf;

// 50th percentile, N m, one side: for a positive and for a negative moment. joint-loads.md 4.2.
struct Capacity {
  double positive, negative;
};
struct BySex {
  Capacity male, female;
};
constexpr BySex kTrunkFlexion = {{143, 234}, {75, 184}};
constexpr BySex kTrunkLateral = {{159, 159}, {94, 94}};
constexpr BySex kTrunkAxial = {{70, 70}, {45, 45}};
constexpr BySex kNeckFlexion = {{30, 51}, {15, 21}};
constexpr BySex kNeckLateral = {{32, 32}, {16, 16}};
constexpr BySex kNeckAxial = {{13, 13}, {6, 6}};
constexpr BySex kShoulderAxial = {{52, 33}, {21, 19}};
constexpr BySex kElbowFlexion = {{77, 46}, {41, 27}};
constexpr BySex kWristPalmar = {{12.2, 7.1}, {7.8, 4.5}};
constexpr BySex kWristRadial = {{11.0, 9.5}, {7.0, 6.1}};
constexpr BySex kHipFlexion = {{185, 190}, {126, 97}};
constexpr BySex kHipAbduction = {{97, 97}, {70, 70}};
constexpr BySex kHipAxial = {{60, 50}, {40, 33}};
constexpr BySex kKneeFlexion = {{100, 168}, {62, 106}};
constexpr BySex kAnkleDorsiflexion = {{43, 126}, {27, 81}};

class Scorer {
 public:
  explicit Scorer(Sex sex) : sex_(sex) {}

  void Try(double moment, const BySex& by_sex, const char* positive, const char* negative) {
    const Capacity& capacity = sex_ == Sex::kMale ? by_sex.male : by_sex.female;
    Try(moment, moment >= 0 ? capacity.positive : capacity.negative,
        moment >= 0 ? positive : negative);
  }

  void Try(double moment, double capacity, const char* channel) {
    const double ratio = std::abs(moment) / capacity;
    if (ratio > best_.ratio || best_.channel[0] == '\0') best_ = {ratio, moment, capacity, channel};
  }

  const Score& best() const { return best_; }

 private:
  Sex sex_;
  Score best_;
};

bool IsLeft(int joint) {
  return (joint >= jLeftC7Shoulder && joint <= jLeftWrist) || joint >= jLeftHip;
}

// The axes of the joint coordinates that belong to MVN's ZXY angles.
struct Axes {
  Vector3d parent_x, parent_y;
  Vector3d child_z;
  Vector3d floating;  // about x
};

Axes AxesOf(int joint, const LinkPoses& links) {
  const Pose& parent = links[At(ParentOf(joint))];
  const Pose& child = links[At(ChildOf(joint))];
  Axes axes;
  axes.parent_x = parent.orientation * Vector3d::UnitX();
  axes.parent_y = parent.orientation * Vector3d::UnitY();
  axes.child_z = child.orientation * Vector3d::UnitZ();
  constexpr double kAlmostParallel = 0.985;
  axes.floating = std::abs(axes.child_z.dot(axes.parent_y)) > kAlmostParallel
                      ? axes.parent_x
                      : axes.child_z.cross(-axes.parent_y).normalized();
  return axes;
}

// 90 - 0.47 per degree of elevation of the upper arm against the trunk, half of it for women.
double ElevationCapacity(int joint, const LinkPoses& links, Sex sex) {
  const Vector3d trunk_up = links[kT8].orientation * Vector3d::UnitZ();
  const Vector3d arm_up = links[At(ChildOf(joint))].orientation * Vector3d::UnitZ();
  const double cosine = std::clamp(trunk_up.dot(arm_up), -1.0, 1.0);
  const double elevation_deg = std::min(std::acos(cosine) * 180 / M_PI, 120.0);
  const double male = 90 - 0.47 * elevation_deg;
  return sex == Sex::kMale ? male : 0.5 * male;
}

}  // namespace

Score ScoreJoint(int joint, const Vector3d& moment, const LinkPoses& links, Sex sex) {
  const Axes axes = AxesOf(joint, links);
  const double side = IsLeft(joint) ? 1 : -1;
  const double about_y = moment.dot(axes.parent_y);
  const double about_x = moment.dot(axes.floating);
  const double about_z = moment.dot(axes.child_z);
  Scorer scorer(sex);
  switch (joint) {
    case jL5S1:
    case jL4L3:
    case jL1T12:
    case jT9T8:
      scorer.Try(about_y, kTrunkFlexion, "flexion", "extension");
      scorer.Try(about_x, kTrunkLateral, "bend right", "bend left");
      scorer.Try(about_z, kTrunkAxial, "turn left", "turn right");
      break;
    case jT1C7:
    case jC1Head:
      scorer.Try(about_y, kNeckFlexion, "flexion", "extension");
      scorer.Try(about_x, kNeckLateral, "bend right", "bend left");
      scorer.Try(about_z, kNeckAxial, "turn left", "turn right");
      break;
    case jRightShoulder:
    case jLeftShoulder:
      scorer.Try((moment - about_z * axes.child_z).norm(), ElevationCapacity(joint, links, sex),
                 "elevation");
      scorer.Try(-side * about_z, kShoulderAxial, "internal rotation", "external rotation");
      break;
    case jRightElbow:
    case jLeftElbow: scorer.Try(-about_y, kElbowFlexion, "flexion", "extension"); break;
    case jRightWrist:
    case jLeftWrist:
      scorer.Try(-side * moment.dot(axes.parent_x), kWristPalmar, "palmar flexion",
                 "dorsal flexion");
      scorer.Try(-about_y, kWristRadial, "radial deviation", "ulnar deviation");
      break;
    case jRightHip:
    case jLeftHip:
      scorer.Try(-about_y, kHipFlexion, "flexion", "extension");
      scorer.Try(side * about_x, kHipAbduction, "abduction", "adduction");
      scorer.Try(-side * about_z, kHipAxial, "internal rotation", "external rotation");
      break;
    case jRightKnee:
    case jLeftKnee: scorer.Try(about_y, kKneeFlexion, "flexion", "extension"); break;
    case jRightAnkle:
    case jLeftAnkle:
      scorer.Try(-about_y, kAnkleDorsiflexion, "dorsiflexion", "plantar flexion");
      break;
    default: break;  // clavicle and ball of the foot are not scored
  }
  return scorer.best();
}

}  // namespace kinescope::loads
