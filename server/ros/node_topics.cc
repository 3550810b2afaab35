#include "server/ros/node_topics.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <kinescope/Mark.h>
#include <ros/this_node.h>
#include <rosgraph_msgs/Log.h>
#include <std_msgs/String.h>

#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {

void PublishState(const std::string& state, const NodeTopics& topics) {
  std_msgs::String message;
  message.data = state;
  topics.state.publish(message);
}

bool PublishLog(const RosLogLine& line, const NodeTopics& topics) {
  if (topics.log.getNumSubscribers() == 0) return false;
  rosgraph_msgs::Log message;
  message.header.stamp = ros::Time::now();
  message.level = static_cast<std::uint8_t>(line.level);
  message.name = ros::this_node::getName();
  message.msg = line.text;
  topics.log.publish(message);
  return true;
}

void PublishDiagnostics(const std::vector<Diagnosis>& all, const NodeTopics& topics) {
  if (topics.diagnostics.getNumSubscribers() == 0) return;
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = ros::Time::now();
  const std::string node = ros::this_node::getName().substr(1);  // without its slash
  for (const Diagnosis& diagnosis : all) {
    diagnostic_msgs::DiagnosticStatus status;
    status.level = static_cast<std::uint8_t>(diagnosis.level);
    status.name = node + ": " + diagnosis.name;
    status.message = diagnosis.message;
    status.hardware_id = "xsens_mvn";
    for (const auto& [key, value] : diagnosis.values) {
      diagnostic_msgs::KeyValue entry;
      entry.key = key;
      entry.value = value;
      status.values.push_back(std::move(entry));
    }
    message.status.push_back(std::move(status));
  }
  topics.diagnostics.publish(message);
}

void PublishMark(const RosMark& mark, const std::string& reference_frame,
                 const NodeTopics& topics) {
  kinescope_ros::Mark message;
  message.header.stamp = ToRosTime(mark.stamp_nanos);
  message.header.frame_id = reference_frame;
  message.id = mark.id;
  message.revision = mark.revision;
  message.button = mark.button;
  message.text = mark.text;
  message.role = mark.role;
  message.counter = mark.counter;
  message.is_span = mark.is_open || mark.end_stamp_nanos;
  message.is_open = mark.is_open;
  message.is_removed = mark.is_removed;
  if (mark.end_stamp_nanos) message.end = ToRosTime(*mark.end_stamp_nanos);
  topics.marks.publish(message);
}

}  // namespace kinescope::ros_bridge
