/// People out of transforms: what comes on /tf and /tf_static, of a bag or of a running ROS graph,
/// joined to samples. Who decides what a frame is: people_frames.h; what a sample is:
/// transform_person.h; when lengths are measured: skeleton_watch.h. Bounded memory, no clock of its
/// own; one thread.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/source.h"
#include "server/ros/people_frames.h"
#include "server/ros/skeleton_watch.h"
#include "server/ros/transform_person.h"

namespace kinescope::ros_bridge {

/// When a message came. `stamp_nanos` does not go back.
struct Arrival {
  std::int64_t stamp_nanos = 0;      // Unix epoch: what stands in where headers cannot be believed
  std::int64_t monotonic_nanos = 0;  // as BodySample::arrival_nanos; 0: out of a file
};

class TransformPeople {
 public:
  /// `settle_nanos`: people are looked for once no frame with a segment's name has been new for so
  /// long. Live, names come one by one, and what is not yet there must not be taken from a robot
  /// that has a "head", too.
  explicit TransformPeople(std::int64_t settle_nanos) : settle_nanos_(settle_nanos) {}

  /// Reading ahead, for names alone: true for a frame that might be a segment.
  bool AddName(const std::string& frame);
  void FindPeople() { frames_.Find(); }

  /// One message. Samples and characters go to `sink`; what cannot be used is counted by reason.
  void Take(const tf2_msgs::TFMessage& message, const Arrival& arrival, SourceCounters& counters,
            SampleSink& sink);
  /// Of /tf_static: such frames are part of every sample that does not bring them itself.
  void TakeStatic(const tf2_msgs::TFMessage& message, SourceCounters& counters);
  /// Nothing more will come: what is left over lacks segments.
  void End(SourceCounters& counters);

  const std::vector<PersonFrames>& people() const { return frames_.people(); }

 private:
  static constexpr std::size_t kMostStatic = 4096;  // frames kept; of robots, too

  struct Person {
    explicit Person(int id) : transforms(id) {}
    TransformPerson transforms;
    SkeletonWatch skeleton;
    bool is_known = false;  // to the sink
  };

  void NoticeNames(const tf2_msgs::TFMessage& message, std::int64_t now);
  /// The transform as one of a person's frames; nothing when it is none, or cannot be used.
  std::optional<FrameTransform> Read(const geometry_msgs::TransformStamped& transform,
                                     SourceCounters& counters) const;
  void AddStatic(const geometry_msgs::TransformStamped& transform, SourceCounters& counters);
  void Give(int index, const Arrival& arrival, SourceCounters& counters, SampleSink& sink);

  const std::int64_t settle_nanos_;
  PeopleFrames frames_;
  std::optional<std::int64_t> new_name_at_;  // names have come since people were looked for
  std::vector<Person> people_;               // by index of frames_.people()
  std::map<std::string, geometry_msgs::TransformStamped> static_;  // by child
  std::set<int> touched_;  // people of whom the present message had something
};

}  // namespace kinescope::ros_bridge
