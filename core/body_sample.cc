#include "core/body_sample.h"

namespace kinescope {

urdf::Pose LinkPoseOf(const BodySample& sample, int segment) {
  const SegmentState& state = sample.segments[urdf::At(segment)];
  return {state.position, state.orientation * urdf::SegmentFromLink(segment)};
}

urdf::LinkPoses LinkPosesOf(const BodySample& sample) {
  urdf::LinkPoses links;
  for (int i = 0; i < urdf::kSegmentCount; ++i) links[urdf::At(i)] = LinkPoseOf(sample, i);
  return links;
}

urdf::SegmentOrientations OrientationsOf(const BodySample& sample) {
  urdf::SegmentOrientations orientations;
  for (std::size_t i = 0; i < orientations.size(); ++i) {
    orientations[i] = sample.segments[i].orientation;
  }
  return orientations;
}

}  // namespace kinescope
