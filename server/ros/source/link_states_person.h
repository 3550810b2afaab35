/// Reads a person from a topic of xsens_mvn_ros_msgs/LinkStateArray, as xsens_mvn_ros and Kinescope
/// publish them: poses as on /tf, with velocities and accelerations. One thread.
#pragma once

#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <string>
#include <utility>

#include "core/skeleton_watch.h"
#include "core/source.h"
#include "server/ros/source/transform_people.h"
#include "server/ros/source/transform_person.h"

namespace kinescope::ros_bridge {

/// "xsens" of "/xsens/link_states": a name for the person, of whom the messages have none.
std::string OwnerOfTopic(const std::string& topic);

class LinkStatesPerson {
 public:
  /// `name` and `character`: of the person. Such a topic belongs to one person.
  explicit LinkStatesPerson(std::string name, int character = 0)
      : name_(std::move(name)), character_(character), transforms_(character) {}

  /// Processes one message: 23 link states, identified by the bare names in their headers; others
  /// are skipped. Stamp: that of the array, else (xsens_mvn_ros leaves it empty) that of the
  /// pelvis. Twists and accelerations that are zero for all links count as not measured. Rejected
  /// messages are counted.
  void Take(const xsens_mvn_ros_msgs::LinkStateArray& message, const Arrival& arrival,
            SampleOrigin& origin, SourceCounters& counters, SampleSink& sink);

 private:
  const std::string name_;
  const int character_;
  TransformPerson transforms_;
  SkeletonWatch skeleton_;
  bool is_known_ = false;  // delivered to the sink
};

}  // namespace kinescope::ros_bridge
