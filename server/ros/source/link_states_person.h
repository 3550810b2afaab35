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

class LinkStatesPerson {
 public:
  /// `name`: of the person. Such a topic belongs to one person, and a source has one of them.
  explicit LinkStatesPerson(std::string name) : name_(std::move(name)) {}

  /// Processes one message: 23 link states, identified by the bare names in their headers; others
  /// are skipped. Stamp: that of the array, else (xsens_mvn_ros leaves it empty) that of the
  /// pelvis. Twists and accelerations that are zero for all links count as not measured. Rejected
  /// messages are counted.
  void Take(const xsens_mvn_ros_msgs::LinkStateArray& message, const Arrival& arrival,
            SourceCounters& counters, SampleSink& sink);

 private:
  const std::string name_;
  TransformPerson transforms_{0};
  SkeletonWatch skeleton_;
  bool is_known_ = false;  // delivered to the sink
};

}  // namespace kinescope::ros_bridge
