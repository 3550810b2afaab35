// Another node, as any subscriber is: hears every topic of one person over TCP and says what came.
//   ros_listener <topic prefix> <epoch>    prefix: "/kinescope/"; epoch: nanoseconds that ~com's x
//                                          counts from, for want of a header
// Writes "heard" when something came on every topic. Then takes lines
//   report <first stamp> <last stamp>
// waits until something later than that came on every topic, so that nothing of it is under way any
// more, and writes for each: topic, messages with a stamp in that range, different stamps among
// them, faulty messages. Then "urdf", links, joints of robot_description.
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <urdf/model.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <iostream>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Heard {
  std::vector<std::int64_t> stamps;
  int faulty = 0;
};

class Listener {
 public:
  Listener(const std::string& prefix, std::int64_t epoch) : epoch_(epoch) {
    Hear<sensor_msgs::JointState>(prefix + "joint_states", [](const auto& message) {
      return message.name.size() == 66 && message.position.size() == 66;
    });
    Hear<xsens_mvn_ros_msgs::LinkStateArray>(prefix + "link_states", [](const auto& message) {
      return message.states.size() == 23 && message.states[0].header.stamp == message.header.stamp;
    });
    Hear<geometry_msgs::Point>(prefix + "com", [](const auto&) { return true; });
    Hear<geometry_msgs::PointStamped>(prefix + "com_stamped", [](const auto&) { return true; });
    Hear<geometry_msgs::PointStamped>(prefix + "cop", [](const auto&) { return true; });
    Hear<visualization_msgs::MarkerArray>(
        prefix + "markers", [](const auto& message) { return message.markers.size() == 10; });
    Hear<tf2_msgs::TFMessage>("/tf", [](const auto& message) {
      std::set<std::string> children;
      for (const auto& one : message.transforms) {
        children.insert(one.child_frame_id);
        if (one.header.stamp != message.transforms[0].header.stamp) return false;
      }
      return children.size() == 67 && children.count("skeleton_head") == 1;
    });
  }

  void WaitForAll() {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait(lock, [&] {
      for (const auto& [topic, heard] : heard_) {
        if (heard.stamps.empty()) return false;
      }
      return true;
    });
  }

  void Report(std::int64_t first, std::int64_t last) {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait_for(lock, std::chrono::seconds(30), [&] {
      for (const auto& [topic, heard] : heard_) {
        if (heard.stamps.back() <= last) return false;
      }
      return true;
    });
    for (const auto& [topic, heard] : heard_) {
      std::vector<std::int64_t> stamps;
      for (const std::int64_t stamp : heard.stamps) {
        if (stamp >= first && stamp <= last) stamps.push_back(stamp);
      }
      const std::set<std::int64_t> different(stamps.begin(), stamps.end());
      std::cout << topic << ' ' << stamps.size() << ' ' << different.size() << ' ' << heard.faulty
                << '\n';
    }
  }

 private:
  template <class Message, class Check>
  void Hear(const std::string& topic, Check check) {
    heard_[topic];
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this, topic, check](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          heard_[topic].stamps.push_back(StampOf(*message));
          if (!check(*message)) ++heard_[topic].faulty;
          came_.notify_all();
        };
    subscribers_.push_back(node_.subscribe<Message>(topic, 0, callback, ros::VoidConstPtr(),
                                                    ros::TransportHints().tcpNoDelay()));
  }

  std::int64_t StampOf(const geometry_msgs::Point& point) const {
    return epoch_ + std::llround(point.x);
  }
  static std::int64_t Nanos(const ros::Time& time) {
    return static_cast<std::int64_t>(time.toNSec());
  }
  static std::int64_t StampOf(const tf2_msgs::TFMessage& message) {
    return Nanos(message.transforms.at(0).header.stamp);
  }
  static std::int64_t StampOf(const visualization_msgs::MarkerArray& message) {
    return Nanos(message.markers.at(0).header.stamp);
  }
  template <class Message>
  static std::int64_t StampOf(const Message& message) {
    return Nanos(message.header.stamp);
  }

  const std::int64_t epoch_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::map<std::string, Heard> heard_;  // guarded by mutex_
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
};

void ReportUrdf() {
  urdf::Model model;
  const bool is_good = model.initParam("robot_description");
  std::cout << "urdf " << (is_good ? model.links_.size() : 0) << ' '
            << (is_good ? model.joints_.size() : 0) << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "listener", ros::init_options::AnonymousName);
  if (argc != 3) return 2;
  Listener listener(argv[1], std::stoll(argv[2]));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  listener.WaitForAll();
  std::cout << "heard" << std::endl;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::string verb;
    std::int64_t first = 0;
    std::int64_t last = 0;
    if (!(words >> verb >> first >> last)) return 2;
    listener.Report(first, last);
    ReportUrdf();
  }
  return 0;
}
