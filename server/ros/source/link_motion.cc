#include "server/ros/source/link_motion.h"

#include <cstddef>

#include "server/ros/raw_message.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using urdf::At;
using xsens_mvn_ros_msgs::LinkState;

constexpr char kNotWhole[] = "sample without all 23 segments";
constexpr char kImplausible[] =
    "link state with a velocity or acceleration that is not finite, or above 100,000";
constexpr double kLargest = 1e5;  // m/s, m/s², rad/s, rad/s²; a person's are below 10,000

template <class RosVector>
Vector3d ToVector(const RosVector& v) {
  return {v.x, v.y, v.z};
}

int SegmentOf(const std::string& link) {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (urdf::kSegments[At(segment)].link_name == link) return segment;
  }
  return -1;
}

}  // namespace

const char* FindLinks(const xsens_mvn_ros_msgs::LinkStateArray& message,
                      LinkStatesBySegment& states) {
  for (const LinkState& state : message.states) {
    const int segment = SegmentOf(WithoutSlash(state.header.frame_id));
    if (segment < 0) continue;
    const auto& p = state.pose.position;
    const auto& r = state.pose.orientation;
    if (const char* defect = DefectOf({p.x, p.y, p.z}, {r.x, r.y, r.z, r.w})) return defect;
    for (const auto& vector :
         {state.twist.linear, state.twist.angular, state.accel.linear, state.accel.angular}) {
      const Vector3d motion = ToVector(vector);
      if (!motion.allFinite() || motion.cwiseAbs().maxCoeff() > kLargest) return kImplausible;
    }
    states[At(segment)] = &state;
  }
  for (const LinkState* state : states) {
    if (state == nullptr) return kNotWhole;
  }
  return nullptr;
}

std::int64_t StampOf(const xsens_mvn_ros_msgs::LinkStateArray& message,
                     const LinkStatesBySegment& states) {
  return ToNanos(message.header.stamp.isZero() ? states[urdf::kPelvis]->header.stamp
                                               : message.header.stamp);
}

void AddMotion(const LinkStatesBySegment& states, BodySample& sample) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    SegmentState& segment = sample.segments[i];
    segment.velocity = ToVector(states[i]->twist.linear);
    segment.angular_velocity = ToVector(states[i]->twist.angular);
    segment.acceleration = ToVector(states[i]->accel.linear);
    segment.angular_acceleration = ToVector(states[i]->accel.angular);
    sample.has_linear =
        sample.has_linear || !segment.velocity.isZero(0) || !segment.acceleration.isZero(0);
    sample.has_angular = sample.has_angular || !segment.angular_velocity.isZero(0) ||
                         !segment.angular_acceleration.isZero(0);
  }
}

}  // namespace kinescope::ros_bridge
