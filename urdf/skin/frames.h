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
/// Rad, by which such a bone has risen: its swing is the smallest from hanging up to the first, and
/// the smallest from the middle of its range beyond the second.
inline constexpr double kNaturalSwingUntil = 60 * M_PI / 180, kMiddleSwingFrom = 150 * M_PI / 180;
/// Where bone lies under the skin of a bent joint: how far the swing frame would move outwards at
/// 180 degrees, m, forward (x). It moves by that times (1 - cos(bend)) / 2.
double FarthestBoneOffset(const Frame& frame);

/// world_from_frame. `fingers`: of gloved hands; null: they keep those of `bind` in the hand.
std::vector<urdf::Pose> FramePoses(const urdf::LinkPoses& links,
                                   const std::array<const urdf::FingerPoses*, 2>& fingers,
                                   const BindPose& bind);

}  // namespace kinescope::skin
