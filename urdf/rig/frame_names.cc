#include "urdf/rig/frame_names.h"

#include <map>

#include "urdf/hand.h"
#include "urdf/segments.h"
#include "urdf/skin/frames.h"

namespace kinescope::rig {

using skin::FrameKind;
using urdf::At;

std::string NameOfFrame(int frame) {
  const skin::Frame& of = skin::Frames()[At(frame)];
  const std::string segment(urdf::kSegments[At(of.segment)].mvn_name);
  const auto finger = [&] { return segment + "_" + std::string(urdf::kFingers[At(of.finger)]); };
  switch (of.kind) {
    case FrameKind::kSegment: return segment;
    case FrameKind::kSwing:
      return segment + "_swing" + std::to_string(frame - skin::SwingFrame(of.segment, 0));
    case FrameKind::kTwist:
      return segment + "_twist" + std::to_string(frame - skin::TwistFrame(of.segment, 0));
    case FrameKind::kFinger: return finger();
    case FrameKind::kHalfFinger: return finger() + "_half";
  }
  return segment;
}

int FrameNamed(const std::string& name) {
  static const std::map<std::string, int> kFrames = [] {
    std::map<std::string, int> frames;
    for (int i = urdf::kSegmentCount; i < static_cast<int>(skin::Frames().size()); ++i) {
      frames[NameOfFrame(i)] = i;
    }
    return frames;
  }();
  const auto found = kFrames.find(name);
  return found == kFrames.end() ? -1 : found->second;
}

}  // namespace kinescope::rig
