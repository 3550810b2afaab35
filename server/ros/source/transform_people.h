/// Assembles the transforms on /tf and /tf_static, of a bag or of a running ROS graph, to samples.
/// people_frames.h identifies the frames, transform_person.h makes the samples, skeleton_watch.h
/// measures the lengths. Memory is limited; no clock; one thread.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/skeleton_watch.h"
#include "core/source.h"
#include "server/ros/source/people_frames.h"
#include "server/ros/source/transform_person.h"

namespace kinescope::ros_bridge {

/// Receive time of a message. `stamp_nanos` goes back only if the clock of the graph, or the wall
/// clock of this computer, was set back; then a person's samples begin anew at its new time.
struct Arrival {
  std::int64_t stamp_nanos = 0;      // the sender's clock; replaces implausible header stamps
  std::int64_t monotonic_nanos = 0;  // as BodySample::arrival_nanos; 0: from a file
};

class TransformPeople {
 public:
  /// `settle_nanos`: people are searched when no new frame with a segment's name has appeared for
  /// this time. Live, the names arrive one by one, and a missing one must not be taken from a robot
  /// that also has a "head".
  explicit TransformPeople(std::int64_t settle_nanos) : settle_nanos_(settle_nanos) {}

  /// Adds a frame name while reading ahead; true if the frame may be a segment.
  bool AddName(const std::string& frame);
  void FindPeople() { frames_.Find(); }

  /// Processes one message. Samples and characters are delivered to `sink`; rejected transforms are
  /// counted by reason. False: the message has no frame of a person.
  bool Take(const tf2_msgs::TFMessage& message, const Arrival& arrival, SourceCounters& counters,
            SampleSink& sink);
  /// Processes a message of /tf_static: its frames are part of every sample that does not contain
  /// them itself.
  void TakeStatic(const tf2_msgs::TFMessage& message, SourceCounters& counters);
  /// End of the input: counts the sets that lack segments.
  void End(SourceCounters& counters);

  const std::vector<PersonFrames>& people() const { return frames_.people(); }
  /// The frame that the first person's samples are in; "" before the first one.
  std::string root() const { return people_.empty() ? "" : people_.front().transforms.root(); }
  /// That of a person; "": there is none, or no sample of them.
  std::string RootOf(int character) const {
    const auto index = static_cast<std::size_t>(character);
    return index < people_.size() ? people_[index].transforms.root() : "";
  }

 private:
  static constexpr std::size_t kMaxStatic = 4096;  // frames kept, those of robots included

  struct Person {
    explicit Person(int id) : transforms(id) {}
    TransformPerson transforms;
    SkeletonWatch skeleton;
    bool is_known = false;  // delivered to the sink
  };

  void NoticeNames(const tf2_msgs::TFMessage& message, std::int64_t now);
  /// The transform, whose child is at `place`, as one of a person's frames; nothing if it is
  /// invalid.
  std::optional<FrameTransform> Read(const geometry_msgs::TransformStamped& transform,
                                     const PeopleFrames::Place& place,
                                     SourceCounters& counters) const;
  void AddStatic(const geometry_msgs::TransformStamped& transform, SourceCounters& counters);
  void Give(int index, const Arrival& arrival, SourceCounters& counters, SampleSink& sink);

  const std::int64_t settle_nanos_;
  PeopleFrames frames_;
  // When the last and the first new name appeared, if people were not searched since.
  std::optional<std::int64_t> new_name_at_, first_new_name_at_;
  std::vector<Person> people_;  // by index of frames_.people()
  SampleOrigin origin_;
  std::map<std::string, geometry_msgs::TransformStamped> static_;  // by child
  std::vector<PeopleFrames::Place> places_;        // of the transforms in the message
  std::map<int, TransformPerson::Slots> touched_;  // by person: their transforms in the message
};

}  // namespace kinescope::ros_bridge
