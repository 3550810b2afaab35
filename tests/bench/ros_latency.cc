// Sample in -> ROS subscriber: subscribes to the ~joint_states of the people of a running
// `kinescope` and prints, for N messages of each, how long after the sample's stamp (its arrival at
// our socket) they came, and how many of the samples between the first and the last one came once
// and in their order.
//   ros_latency 2000 240 /kinescope/joint_states [/kinescope/skeleton_1/joint_states ...]
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

struct Topic {
  std::vector<ros::Time> stamps;
  std::size_t not_later = 0;  // than the message before
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "ros_latency", ros::init_options::AnonymousName);
  if (argc < 4) {
    std::fprintf(stderr, "ros_latency COUNT RATE_HZ TOPIC...\n");
    return 2;
  }
  const auto wanted = static_cast<std::size_t>(std::atoi(argv[1]));
  const double rate_hz = std::atof(argv[2]);
  std::vector<double> millis;
  std::vector<Topic> topics(static_cast<std::size_t>(argc - 3));
  std::size_t complete = 0;
  ros::NodeHandle node;
  std::vector<ros::Subscriber> subscribers;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const boost::function<void(const sensor_msgs::JointStateConstPtr&)> callback =
        [&, i](const sensor_msgs::JointStateConstPtr& message) {
          Topic& topic = topics[i];
          if (topic.stamps.size() >= wanted) return;
          const ros::Time& stamp = message->header.stamp;
          millis.push_back((ros::Time::now() - stamp).toSec() * 1e3);
          if (!topic.stamps.empty() && stamp <= topic.stamps.back()) ++topic.not_later;
          topic.stamps.push_back(stamp);
          if (topic.stamps.size() == wanted && ++complete == topics.size()) ros::shutdown();
        };
    subscribers.push_back(node.subscribe<sensor_msgs::JointState>(
        argv[i + 3], 0, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
  ros::spin();
  if (millis.empty()) return 1;
  std::size_t came = 0, sent = 0, not_later = 0;
  for (const Topic& topic : topics) {
    if (topic.stamps.size() < 2) return 1;
    came += topic.stamps.size();
    not_later += topic.not_later;
    const double secs = (topic.stamps.back() - topic.stamps.front()).toSec();
    sent += static_cast<std::size_t>(std::lround(secs * rate_hz)) + 1;
  }
  std::sort(millis.begin(), millis.end());
  const auto at = [&](double part) {
    return millis[static_cast<std::size_t>(part * (millis.size() - 1))];
  };
  std::printf(
      "%zu of %zu samples, %zu out of order; ms after the stamp: p50 %.2f, p95 %.2f, p99 %.2f, "
      "max %.2f\n",
      came, sent, not_later, at(0.5), at(0.95), at(0.99), millis.back());
  return 0;
}
