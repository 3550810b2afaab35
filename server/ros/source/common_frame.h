/// Brings people whose frames hang on different ones into one frame, by the transforms between
/// these. One thread.
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <set>
#include <string>

#include "core/body_sample.h"
#include "server/ros/force_frames.h"

namespace kinescope::ros_bridge {

class CommonFrame {
 public:
  /// `source`: for messages. `wanted`: the frame that is taken where TF connects it with that of
  /// the first person; "": that of the first person is.
  CommonFrame(std::string source, std::string wanted);

  /// A message of /tf or /tf_static. What is not static is kept only if people need it.
  void Take(const tf2_msgs::TFMessage& message, bool is_static);

  /// Brings the segments of a sample to the common frame. A sample for which TF has no way there
  /// stays as it is, and after two seconds of its clock that is told, once for each frame.
  /// @param root  the frame that the sample is in; "": that is not known
  /// @param of_first  that of the first person
  void Bring(BodySample& sample, const std::string& root, const std::string& of_first);

 private:
  void NoteLost(const std::string& root, const std::string& target, std::int64_t now_nanos);

  const std::string source_, wanted_;
  TfTree tree_;
  bool keeps_moving_ = false;
  std::int64_t lost_nanos_ = 0;  // since then there is a sample without a way; 0: there is none
  std::set<std::string> told_;
};

}  // namespace kinescope::ros_bridge
