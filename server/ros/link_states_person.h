/// A person out of a topic of xsens_mvn_ros_msgs/LinkStateArray, as xsens_mvn_ros and Kinescope
/// publish them: poses as on /tf, and with them velocities and accelerations. One thread.
#pragma once

#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <string>
#include <utility>

#include "core/source.h"
#include "server/ros/skeleton_watch.h"
#include "server/ros/transform_people.h"
#include "server/ros/transform_person.h"

namespace kinescope::ros_bridge {

class LinkStatesPerson {
 public:
  /// `name`: of the person; such a topic is one person's, and a source has one of them.
  explicit LinkStatesPerson(std::string name) : name_(std::move(name)) {}

  /// One message: 23 link states, told apart by the bare names in their headers; others are passed
  /// over. Stamp: the array's, else (xsens_mvn_ros leaves that empty) the pelvis'. Twists and
  /// accelerations that are zero throughout were not measured. What cannot be used is counted.
  void Take(const xsens_mvn_ros_msgs::LinkStateArray& message, const Arrival& arrival,
            SourceCounters& counters, SampleSink& sink);

 private:
  const std::string name_;
  TransformPerson transforms_{0};
  SkeletonWatch skeleton_;
  bool is_known_ = false;  // to the sink
};

}  // namespace kinescope::ros_bridge
