#include "urdf/skin/frames.h"

#include <algorithm>
#include <cmath>

#include "urdf/turn_between.h"

namespace kinescope::skin {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()));
}

double TwistAngle(const Quaterniond& rotation) {
  return std::remainder(2 * std::atan2(rotation.z(), rotation.w()), 2 * M_PI);
}

// parent_from_child = swing * twist; twist: about the bone (z).
struct JointTurn {
  double risen = 0;                      // of the bone, from hanging, rad
  Vector3d towards = Vector3d::UnitX();  // level, unit: where it rises to
  Quaterniond rise, rest;                // swing = rise * rest; rise: about a level axis
  Quaterniond twist = Quaterniond::Identity();

  // As far as `share` of the swing.
  Quaterniond PartOfSwing(double share) const {
    const Quaterniond identity = Quaterniond::Identity();
    return identity.slerp(share, rise) * identity.slerp(share, rest);
  }
};

// The bone rises in its own plane, as the muscles above the joint do, and has no twist then.
// Straight up that plane could be any, so it goes over to that of the middle of the range.
JointTurn Split(int segment, const Quaterniond& parent_from_child) {
  JointTurn turn;
  const Vector3d bone = parent_from_child * Vector3d::UnitZ();
  turn.risen = std::acos(std::clamp(bone.z(), -1.0, 1.0));
  const double t = std::clamp((turn.risen - kOwnPlaneUntil) / (M_PI - kOwnPlaneUntil), 0.0, 1.0);
  const Vector3d middle = MiddleOfRange(segment) * Vector3d::UnitZ();
  const Vector3d plane = bone + kMiddleShare * t * t * (3 - 2 * t) * middle;
  const Vector3d level(-plane.x(), -plane.y(), 0);
  if (level.norm() > 1e-9) turn.towards = level.normalized();
  if (TwistFrames(segment) == 0) {
    turn.rise = parent_from_child;
    turn.rest = Quaterniond::Identity();
    return turn;
  }
  const Vector3d axis(turn.towards.y(), -turn.towards.x(), 0);
  turn.rise = Quaterniond(Eigen::AngleAxisd(turn.risen, axis));
  const Quaterniond swing = urdf::TurnBetween(turn.rise * Vector3d::UnitZ(), bone) * turn.rise;
  turn.rest = turn.rise.conjugate() * swing;
  turn.twist = Quaterniond(
      Eigen::AngleAxisd(TwistAngle(swing.conjugate() * parent_from_child), Vector3d::UnitZ()));
  return turn;
}

Vector3d MoveOf(const Frame& frame, const JointTurn& turn) {
  const double bent = 0.5 * (1 - std::cos(turn.risen));
  const FarthestMove most = FarthestMoveOf(frame);
  const Vector3d move =
      bent * most.into_bend * turn.towards + turn.risen / M_PI * most.up_bone * Vector3d::UnitZ();
  return Quaterniond::Identity().slerp(0.5, turn.rise) * move;
}

// Frames, and where those of each segment begin.
struct FrameList {
  std::vector<Frame> all;
  std::array<int, urdf::kSegmentCount> swing{}, twist{};
  std::array<std::array<int, urdf::kFingersPerHand>, 2> finger{};
};

const FrameList& List() {
  static const FrameList kList = [] {
    FrameList list;
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      list.all.push_back({FrameKind::kSegment, segment, 1, -1});
    }
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      list.swing[urdf::At(segment)] = static_cast<int>(list.all.size());
      const int swings = SwingFrames(segment), twists = TwistFrames(segment);
      for (int i = 1; i <= swings; ++i) {
        list.all.push_back({FrameKind::kSwing, segment, static_cast<double>(i) / (swings + 1), -1});
      }
      list.twist[urdf::At(segment)] = static_cast<int>(list.all.size());
      for (int i = 0; i < twists; ++i) {
        list.all.push_back({FrameKind::kTwist, segment, static_cast<double>(i) / twists, -1});
      }
    }
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      for (int finger = 0; finger < urdf::kFingersPerHand; ++finger) {
        list.finger[side][urdf::At(finger)] = static_cast<int>(list.all.size());
        if (!HasFrames(finger)) continue;
        const int hand = urdf::HandSegmentOf(side);
        list.all.push_back({FrameKind::kFinger, hand, 1, finger});
        list.all.push_back({FrameKind::kHalfFinger, hand, 0.5, finger});
      }
    }
    return list;
  }();
  return kList;
}

}  // namespace

int SwingFrames(int segment) {
  switch (segment) {
    case urdf::kRightUpperArm:
    case urdf::kLeftUpperArm: return 4;
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg: return 3;
    case urdf::kRightForeArm:
    case urdf::kLeftForeArm:
    case urdf::kRightLowerLeg:
    case urdf::kLeftLowerLeg: return 5;
    case urdf::kRightHand:
    case urdf::kLeftHand:
    case urdf::kRightFoot:
    case urdf::kLeftFoot: return 2;
    case urdf::kRightToe:
    case urdf::kLeftToe:
    case urdf::kNeck:
    case urdf::kHead: return 1;
    default: return 0;
  }
}

int TwistFrames(int segment) {
  switch (segment) {
    case urdf::kRightUpperArm:
    case urdf::kLeftUpperArm: return 4;
    case urdf::kRightForeArm:
    case urdf::kLeftForeArm: return 5;
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg: return 3;
    default: return 0;
  }
}

bool HasFrames(int finger) {
  return finger > 0 && (urdf::RayOf(finger) == 0 || urdf::PlaceInRay(finger) > 0);
}

const std::vector<Frame>& Frames() { return List().all; }
int SegmentFrame(int segment) { return segment; }
int SwingFrame(int segment, int step) { return List().swing[urdf::At(segment)] + step; }
int TwistFrame(int segment, int step) { return List().twist[urdf::At(segment)] + step; }
int FingerFrame(int hand, int finger, bool is_half) {
  const urdf::Side side = hand == urdf::kLeftHand ? urdf::kLeft : urdf::kRight;
  return List().finger[side][urdf::At(finger)] + (is_half ? 1 : 0);
}

Quaterniond MiddleOfRange(int segment) {
  switch (segment) {
    case urdf::kRightUpperArm: return Turn(75, {-1, -1, 0});
    case urdf::kLeftUpperArm: return Turn(75, {1, -1, 0});
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg: return Turn(-45, Vector3d::UnitY());
    default: return Quaterniond::Identity();
  }
}

FarthestMove FarthestMoveOf(const Frame& frame) {
  FarthestMove move;  // of the frame in the middle of the joint
  switch (frame.segment) {
    case urdf::kRightUpperArm:
    case urdf::kLeftUpperArm: move.up_bone = 0.040; break;
    case urdf::kRightForeArm:
    case urdf::kLeftForeArm: move.into_bend = -0.012; break;
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg: move.into_bend = 0.016; break;
    case urdf::kRightLowerLeg:
    case urdf::kLeftLowerLeg: move.into_bend = -0.009; break;
    default: break;
  }
  const double from_middle = 2 * frame.share - 1, share = 1 - from_middle * from_middle;
  return {share * move.into_bend, share * move.up_bone};
}

std::vector<urdf::Pose> FramePoses(const urdf::LinkPoses& links,
                                   const std::array<const urdf::FingerPoses*, 2>& fingers,
                                   const BindPose& bind) {
  std::array<JointTurn, urdf::kSegmentCount> joints;
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const urdf::Pose& parent = links[urdf::At(urdf::kSegments[urdf::At(segment)].parent)];
    joints[urdf::At(segment)] =
        Split(segment, parent.orientation.conjugate() * links[urdf::At(segment)].orientation);
  }
  std::array<urdf::FingerPoses, 2> hands;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (fingers[side] != nullptr) {
      hands[side] = *fingers[side];
      continue;
    }
    const auto hand = urdf::At(urdf::HandSegmentOf(side));
    for (std::size_t i = 0; i < hands[side].size(); ++i) {
      const urdf::Pose in_hand = Relative(bind.links[hand], bind.fingers[side][i]);
      hands[side][i] = {links[hand].position + links[hand].orientation * in_hand.position,
                        links[hand].orientation * in_hand.orientation};
    }
  }
  std::vector<urdf::Pose> poses;
  poses.reserve(Frames().size());
  for (const Frame& frame : Frames()) {
    const urdf::Pose& link = links[urdf::At(frame.segment)];
    const int parent = urdf::kSegments[urdf::At(frame.segment)].parent;
    const JointTurn& joint = joints[urdf::At(frame.segment)];
    switch (frame.kind) {
      case FrameKind::kSegment: poses.push_back(link); break;
      case FrameKind::kSwing: {
        const Quaterniond& up = links[urdf::At(parent)].orientation;
        poses.push_back(
            {link.position + up * MoveOf(frame, joint), up * joint.PartOfSwing(frame.share)});
        break;
      }
      case FrameKind::kTwist:
        poses.push_back(
            {link.position, links[urdf::At(parent)].orientation * joint.PartOfSwing(1) *
                                Quaterniond::Identity().slerp(frame.share, joint.twist)});
        break;
      case FrameKind::kFinger:
      case FrameKind::kHalfFinger: {
        const urdf::FingerPoses& hand =
            hands[frame.segment == urdf::kLeftHand ? urdf::kLeft : urdf::kRight];
        const urdf::Pose& finger = hand[urdf::At(frame.finger)];
        if (frame.kind == FrameKind::kFinger) {
          poses.push_back(finger);
          break;
        }
        const int before = urdf::kFingerParents[urdf::At(frame.finger)];
        const Quaterniond& up =
            HasFrames(before) ? hand[urdf::At(before)].orientation : link.orientation;
        poses.push_back({finger.position, up.slerp(0.5, finger.orientation)});
        break;
      }
    }
  }
  return poses;
}

}  // namespace kinescope::skin
