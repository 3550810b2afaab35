#include "server/ros/source/link_states_person.h"

#include <array>

#include "server/ros/raw_message.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using urdf::At;
using xsens_mvn_ros_msgs::LinkState;

constexpr char kNotWhole[] = "sample without all 23 segments";
constexpr char kNotFinite[] = "link state with a velocity or acceleration that is not finite";

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

// By segment; null if the message has none.
using States = std::array<const LinkState*, urdf::kSegmentCount>;

// Null if all can be used, else the key of the counter for the message.
const char* Sort(const xsens_mvn_ros_msgs::LinkStateArray& message, States& states) {
  for (const LinkState& state : message.states) {
    const int segment = SegmentOf(WithoutSlash(state.header.frame_id));
    if (segment < 0) continue;
    const auto& p = state.pose.position;
    const auto& r = state.pose.orientation;
    if (const char* defect = DefectOf({p.x, p.y, p.z}, {r.x, r.y, r.z, r.w})) return defect;
    for (const auto& vector :
         {state.twist.linear, state.twist.angular, state.accel.linear, state.accel.angular}) {
      if (!ToVector(vector).allFinite()) return kNotFinite;
    }
    states[At(segment)] = &state;
  }
  for (const LinkState* state : states) {
    if (state == nullptr) return kNotWhole;
  }
  return nullptr;
}

// Adds the values that TF does not contain.
void AddMotion(const States& states, BodySample& sample) {
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

}  // namespace

void LinkStatesPerson::Take(const xsens_mvn_ros_msgs::LinkStateArray& message,
                            const Arrival& arrival, SourceCounters& counters, SampleSink& sink) {
  States states{};
  if (const char* defect = Sort(message, states)) {
    ++counters.rejected[defect];
    return;
  }
  const ros::Time stamp =
      message.header.stamp.isZero() ? states[urdf::kPelvis]->header.stamp : message.header.stamp;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const geometry_msgs::Pose& pose = states[At(segment)]->pose;
    const auto& r = pose.orientation;
    FrameTransform transform;
    transform.slot = segment;
    transform.parent_from_child = {ToVector(pose.position),
                                   Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized()};
    transform.header_nanos = ToNanos(stamp);
    transform.record_nanos = arrival.stamp_nanos;
    transforms_.Add(transform);
  }
  const std::uint64_t steps_back = transforms_.steps_back();
  if (transforms_.Finish(arrival.monotonic_nanos) == TransformPerson::Result::kDuplicate) {
    ++counters.duplicates;
    return;
  }
  counters.restarts += transforms_.steps_back() - steps_back;
  BodySample sample = transforms_.sample();
  AddMotion(states, sample);
  const auto skeleton = skeleton_.Look(sample);
  if (skeleton || !is_known_) {
    is_known_ = true;
    Character character;
    character.name = name_;
    character.skeleton = skeleton;
    sink.OnCharacter(character);
  }
  ++counters.samples;
  sink.OnSample(sample);
}

}  // namespace kinescope::ros_bridge
