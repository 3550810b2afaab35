// Sample in -> ROS subscriber: subscribes to ~joint_states of a running `kinescope` and prints, for
// N messages, how long after the sample's stamp (its arrival at our socket) each came, and the
// gaps.
//   ros_latency /kinescope/joint_states 2000
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
  ros::init(argc, argv, "ros_latency", ros::init_options::AnonymousName);
  if (argc != 3) {
    std::fprintf(stderr, "ros_latency TOPIC COUNT\n");
    return 2;
  }
  const auto wanted = static_cast<std::size_t>(std::atoi(argv[2]));
  std::vector<double> millis;
  std::vector<ros::Time> stamps;
  ros::NodeHandle node;
  const boost::function<void(const sensor_msgs::JointStateConstPtr&)> callback =
      [&](const sensor_msgs::JointStateConstPtr& message) {
        millis.push_back((ros::Time::now() - message->header.stamp).toSec() * 1e3);
        stamps.push_back(message->header.stamp);
        if (millis.size() >= wanted) ros::shutdown();
      };
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::JointState>(
      argv[1], 0, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::spin();
  if (millis.empty()) return 1;
  const double secs = (stamps.back() - stamps.front()).toSec();
  std::sort(millis.begin(), millis.end());
  const auto at = [&](double part) {
    return millis[static_cast<std::size_t>(part * (millis.size() - 1))];
  };
  std::printf("%zu messages, %.1f Hz; ms after the stamp: p50 %.2f, p95 %.2f, p99 %.2f, max %.2f\n",
              millis.size(), (millis.size() - 1) / secs, at(0.5), at(0.95), at(0.99),
              millis.back());
  return 0;
}
