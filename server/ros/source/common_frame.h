/// Brings people whose frames hang on different ones into one frame, by the transforms between
/// these. One thread.
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/body_sample.h"
#include "server/ros/force_frames.h"

namespace kinescope::ros_bridge {

/// Contact and loads are those of a person on a floor that stands, so a frame that moves in the
/// common one, such as a cart, is taken where it was first, which is told.
class CommonFrame {
 public:
  /// `source`: for messages. `wanted`: the frame that people are brought to where TF connects it
  /// with theirs; "": that of the first person.
  CommonFrame(std::string source, std::string wanted);

  /// A message of /tf or /tf_static. What is not static is kept only if people need it.
  void Take(const tf2_msgs::TFMessage& message, bool is_static);

  /// Brings the segments of a sample to the common frame. A sample for which TF has no way there
  /// stays as it is, and after two seconds of its clock that is told, once for each frame.
  /// @param root  the frame that the sample is in; "": that is not known
  /// @param of_first  that of the first person
  void Bring(BodySample& sample, const std::string& root, const std::string& of_first);

  /// As SourceCounters::problems: of the frames that people are in now.
  std::vector<std::string> problems() const;

 private:
  struct Root {
    std::int64_t brought_nanos = 0;  // stamp of the newest sample in it
    std::int64_t lost_nanos = 0;     // since then there is no way; 0: there is one
    std::string problem;             // "": none
    bool is_told_lost = false, is_told_moving = false;
    bool is_placed = false;
    urdf::Pose held, seen;         // where it is taken; where it was last
    std::int64_t seen_nanos = 0;   // since then it stands there
    std::int64_t moved_nanos = 0;  // since then it is elsewhere than it is taken; 0: it is there
  };

  void NoteLost(Root& known, const std::string& root, const std::string& of_first,
                std::int64_t now_nanos) const;
  void Tell(Root& known, std::string problem, bool& is_told) const;
  void Hold(Root& known, const std::string& root, const urdf::Pose& place,
            std::int64_t now_nanos) const;

  const std::string source_, wanted_;
  TfTree tree_;
  bool keeps_moving_ = false;
  std::int64_t newest_nanos_ = 0;      // stamp of the newest sample
  std::map<std::string, Root> roots_;  // of people, of whom there are few
};

}  // namespace kinescope::ros_bridge
