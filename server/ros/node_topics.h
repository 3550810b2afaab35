/// The topics of the node that belong to no person: `/diagnostics`, `/rosout`, `/kinescope/people`,
/// `~state`, `~marks`, `~mark`, and `~parameter_descriptions` and `~parameter_updates` of
/// dynamic_reconfigure.
#pragma once

#include <ros/publisher.h>

#include <string>
#include <vector>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

/// Any thread may publish.
struct NodeTopics {
  ros::Publisher diagnostics, marks, state, log, people;
  ros::Publisher settings, settings_now;  // descriptions, and values
};

void PublishState(const std::string& state, const NodeTopics& topics);
/// False without subscribers.
bool PublishLog(const RosLogLine& line, const NodeTopics& topics);
/// Publishes nothing without subscribers.
void PublishDiagnostics(const std::vector<Diagnosis>& all, const NodeTopics& topics);
void PublishMark(const RosMark& mark, const std::string& reference_frame, const NodeTopics& topics);

}  // namespace kinescope::ros_bridge
