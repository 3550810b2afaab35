#include "server/ros/source/link_states_person.h"

#include "server/ros/source/link_motion.h"

namespace kinescope::ros_bridge {

using urdf::At;

std::string OwnerOfTopic(const std::string& topic) {
  const std::size_t end = topic.rfind('/');
  if (end == std::string::npos || end == 0) return "";
  const std::size_t begin = topic.rfind('/', end - 1) + 1;
  return topic.substr(begin, end - begin);
}

void LinkStatesPerson::Take(const xsens_mvn_ros_msgs::LinkStateArray& message,
                            const Arrival& arrival, SampleOrigin& origin, SourceCounters& counters,
                            SampleSink& sink) {
  LinkStatesBySegment states{};
  if (const char* defect = FindLinks(message, states)) {
    ++counters.rejected[defect];
    return;
  }
  const std::int64_t stamp = StampOf(message, states);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const geometry_msgs::Pose& pose = states[At(segment)]->pose;
    const auto& r = pose.orientation;
    FrameTransform transform;
    transform.slot = segment;
    transform.parent_from_child = {{pose.position.x, pose.position.y, pose.position.z},
                                   Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized()};
    transform.header_nanos = stamp;
    transform.record_nanos = arrival.stamp_nanos;
    transforms_.Add(transform);
  }
  const std::uint64_t steps_back = transforms_.steps_back();
  if (transforms_.Finish(arrival.monotonic_nanos, origin) == TransformPerson::Result::kDuplicate) {
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
    character.id = character_;
    character.name = name_;
    character.skeleton = skeleton;
    sink.OnCharacter(character);
  }
  ++counters.samples;
  sink.OnSample(sample);
}

}  // namespace kinescope::ros_bridge
