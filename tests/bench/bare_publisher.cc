// The least that a message of roscpp costs, for ros_latency: publishes as many joint states as a
// person has, at the rate that is given, with the time as their stamp, and computes nothing.
//   bare_publisher 240
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <cstdio>
#include <cstdlib>
#include <string>

int main(int argc, char** argv) {
  ros::init(argc, argv, "bare");
  if (argc != 2) {
    std::fprintf(stderr, "bare_publisher RATE_HZ\n");
    return 2;
  }
  ros::NodeHandle node;
  const ros::Publisher publisher = node.advertise<sensor_msgs::JointState>("/bare/joint_states", 1);
  sensor_msgs::JointState message;
  for (int joint = 0; joint < 66; ++joint) {
    message.name.push_back("bare_joint_" + std::to_string(joint));
    message.position.push_back(joint);
  }
  for (ros::WallRate rate(std::atof(argv[1])); ros::ok(); rate.sleep()) {
    message.header.stamp = ros::Time::now();
    publisher.publish(message);
  }
  return 0;
}
