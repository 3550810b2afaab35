/// The frames that carry the skin, computed from the 23 segments and the fingers. A joint has
/// frames that turn by part of its swing, so that no fold closes and no bend loses volume; upper
/// arm, forearm and thigh have frames that carry part of their twist, as bones and muscles do
/// (virtual bones, Kavan, Collins, O'Sullivan 2009). Vertices lie between two neighbours. Pure
/// functions, any thread.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "urdf/hand.h"
#include "urdf/kinematics.h"
#include "urdf/skin/bind_pose.h"

namespace kinescope::skin {

enum class FrameKind {
  kSegment,     // a segment itself
  kSwing,       // at its joint, turned by `share` of its swing
  kTwist,       // at its joint, with the swing and `share` of its twist
  kFinger,      // a segment of the right or left hand (urdf::kFingers)
  kHalfFinger,  // at its joint, turned half
};

struct Frame {
  FrameKind kind = FrameKind::kSegment;
  int segment = 0;  // urdf::Segment; of a finger: the hand
  double share = 1;
  int finger = -1;  // index of urdf::kFingers
};

/// All frames, in the order of FramePoses(). At most 256.
const std::vector<Frame>& Frames();

/// The frame's index. `step`: of the frames of this kind and segment.
/// @pre there is one
int SegmentFrame(int segment);
int SwingFrame(int segment, int step);
int TwistFrame(int segment, int step);
int FingerFrame(int hand, int finger, bool is_half);

/// The number of frames of a kind.
int SwingFrames(int segment);
int TwistFrames(int segment);
/// Whether the finger segment has frames: thumb and phalanges do, carpus and other metacarpals move
/// with the hand.
bool HasFrames(int finger);

/// Of a joint with twist frames: the middle of its range, seen from hanging.
Eigen::Quaterniond MiddleOfRange(int segment);
/// A bone swings in the vertical plane of its parent in which it points. Risen by more than the
/// first, rad, the middle of its range counts for that plane too, straight up by the second.
inline constexpr double kOwnPlaneUntil = 60 * M_PI / 180, kMiddleShare = 0.2;

/// How far a swing frame leaves its joint when that is bent by 180 degrees, m, in the axes of the
/// joint turned half: the bone of an elbow stands out, the shoulder rises with its arm.
struct FarthestMove {
  double into_bend = 0;  // to the hollow side; grows with (1 - cos(bend)) / 2
  double up_bone = 0;    // from the bone's end to its joint; grows with the bend
};
FarthestMove FarthestMoveOf(const Frame& frame);

/// world_from_frame. `fingers`: of gloved hands; null: they keep those of `bind` in the hand.
std::vector<urdf::Pose> FramePoses(const urdf::LinkPoses& links,
                                   const std::array<const urdf::FingerPoses*, 2>& fingers,
                                   const BindPose& bind);

}  // namespace kinescope::skin
