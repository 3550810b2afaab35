#include "urdf/segments.h"

#include <cmath>

namespace kinescope::urdf {

const std::array<SegmentInfo, kSegmentCount> kSegments = {{
    {"Pelvis", "pelvis", -1},
    {"L5", "l5", kPelvis},
    {"L3", "l3", kL5},
    {"T12", "t12", kL3},
    {"T8", "t8", kT12},
    {"Neck", "neck", kT8},
    {"Head", "head", kNeck},
    {"RightShoulder", "right_shoulder", kT8},
    {"RightUpperArm", "right_upper_arm", kRightShoulder},
    {"RightForeArm", "right_forearm", kRightUpperArm},
    {"RightHand", "right_hand", kRightForeArm},
    {"LeftShoulder", "left_shoulder", kT8},
    {"LeftUpperArm", "left_upper_arm", kLeftShoulder},
    {"LeftForeArm", "left_forearm", kLeftUpperArm},
    {"LeftHand", "left_hand", kLeftForeArm},
    {"RightUpperLeg", "right_upper_leg", kPelvis},
    {"RightLowerLeg", "right_lower_leg", kRightUpperLeg},
    {"RightFoot", "right_foot", kRightLowerLeg},
    {"RightToe", "right_toe", kRightFoot},
    {"LeftUpperLeg", "left_upper_leg", kPelvis},
    {"LeftLowerLeg", "left_lower_leg", kLeftUpperLeg},
    {"LeftFoot", "left_foot", kLeftLowerLeg},
    {"LeftToe", "left_toe", kLeftFoot},
}};

const std::array<JointInfo, kJointCount> kJoints = {{
    {"jL5S1", "l5_s1", "L5/S1"},
    {"jL4L3", "l4_l3", "L4/L3"},
    {"jL1T12", "l1_t12", "L1/T12"},
    {"jT9T8", "t9_t8", "T9/T8"},
    {"jT1C7", "t1_c7", "Neck (T1/C7)"},
    {"jC1Head", "c1_head", "Head (C1)"},
    {"jRightC7Shoulder", "right_c7_shoulder", "Right C7 shoulder"},
    {"jRightShoulder", "right_shoulder", "Right shoulder"},
    {"jRightElbow", "right_elbow", "Right elbow"},
    {"jRightWrist", "right_wrist", "Right wrist"},
    {"jLeftC7Shoulder", "left_c7_shoulder", "Left C7 shoulder"},
    {"jLeftShoulder", "left_shoulder", "Left shoulder"},
    {"jLeftElbow", "left_elbow", "Left elbow"},
    {"jLeftWrist", "left_wrist", "Left wrist"},
    {"jRightHip", "right_hip", "Right hip"},
    {"jRightKnee", "right_knee", "Right knee"},
    {"jRightAnkle", "right_ankle", "Right ankle"},
    {"jRightBallFoot", "right_ballfoot", "Right ball of foot"},
    {"jLeftHip", "left_hip", "Left hip"},
    {"jLeftKnee", "left_knee", "Left knee"},
    {"jLeftAnkle", "left_ankle", "Left ankle"},
    {"jLeftBallFoot", "left_ballfoot", "Left ball of foot"},
}};

const std::array<int, kScoredJointCount> kScoredJoints = {
    jL5S1,       jT9T8,      jT1C7,       jRightShoulder, jLeftShoulder,
    jRightElbow, jLeftElbow, jRightWrist, jLeftWrist,     jRightHip,
    jLeftHip,    jRightKnee, jLeftKnee,   jRightAnkle,    jLeftAnkle};

JointGroup JointGroupOf(int joint) {
  switch (joint) {
    case jL5S1:
    case jL4L3:
    case jL1T12:
    case jT9T8: return JointGroup::kSpine;
    case jT1C7:
    case jC1Head: return JointGroup::kNeck;
    case jRightC7Shoulder:
    case jLeftC7Shoulder: return JointGroup::kClavicle;
    case jRightShoulder:
    case jLeftShoulder: return JointGroup::kShoulder;
    case jRightElbow:
    case jLeftElbow: return JointGroup::kElbow;
    case jRightWrist:
    case jLeftWrist: return JointGroup::kWrist;
    case jRightHip:
    case jLeftHip: return JointGroup::kHip;
    case jRightKnee:
    case jLeftKnee: return JointGroup::kKnee;
    case jRightAnkle:
    case jLeftAnkle: return JointGroup::kAnkle;
    default: return JointGroup::kBallOfFoot;
  }
}

std::optional<Segment> FindSegment(std::string_view mvn_name) {
  for (int i = 0; i < kSegmentCount; ++i) {
    if (kSegments[static_cast<std::size_t>(i)].mvn_name == mvn_name) return static_cast<Segment>(i);
  }
  return std::nullopt;
}

std::optional<Joint> FindJoint(std::string_view mvn_name) {
  if (mvn_name == "jRightT4Shoulder") return jRightC7Shoulder;
  if (mvn_name == "jLeftT4Shoulder") return jLeftC7Shoulder;
  for (int i = 0; i < kJointCount; ++i) {
    if (kJoints[static_cast<std::size_t>(i)].mvn_name == mvn_name) return static_cast<Joint>(i);
  }
  return std::nullopt;
}

const Eigen::Quaterniond& SegmentFromLink(int segment) {
  static const Eigen::Quaterniond kNone = Eigen::Quaterniond::Identity();
  static const Eigen::Quaterniond kRightTurn(M_SQRT1_2, -M_SQRT1_2, 0, 0);  // Rx(-90 deg)
  static const Eigen::Quaterniond kLeftTurn(M_SQRT1_2, M_SQRT1_2, 0, 0);    // Rx(+90 deg)
  switch (segment) {
    case kRightUpperArm:
    case kRightForeArm:
    case kRightHand: return kRightTurn;
    case kLeftUpperArm:
    case kLeftForeArm:
    case kLeftHand: return kLeftTurn;
    default: return kNone;
  }
}

}  // namespace kinescope::urdf
