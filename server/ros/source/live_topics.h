/// Subscribes to topics of a running ROS graph, and again after the master starts or restarts.
/// roscpp registers a subscription once, blocks while no master is reachable, and never registers
/// again. So a separate thread starts roscpp when a master first answers, and checks the
/// registration at the master once a second. The reading thread only takes received messages.
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/ros/master_client.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {

class LiveTopics {
 public:
  using Event = RawEvent;
  using OnMessage = std::function<void(std::size_t topic, const Event& event)>;

  struct Status {
    bool master_answers = false;          // at the last check; checked once a second
    std::vector<std::size_t> publishers;  // connected, by topic
    bool shutdown_requested = false;      // `rosnode kill`, another node took this node's name, or
                                          // roscpp failed: no more messages
  };

  /// Subscribes to `topics`, which are resolved names; `on_message` gets the index of the topic.
  /// `description`: name of the source in log lines.
  /// @pre ros::init was called.
  LiveTopics(std::vector<std::string> topics, std::string description, OnMessage on_message);
  /// Shuts this node down, unless a bridge has done so before.
  ~LiveTopics();
  LiveTopics(const LiveTopics&) = delete;
  LiveTopics& operator=(const LiveTopics&) = delete;

  /// Waits at most `timeout` for messages and passes on those received, for a limited time: the
  /// rest is left to the next call. Called by one thread.
  void Take(std::chrono::milliseconds timeout);
  Status status() const;  // any thread

 private:
  void Run();
  void AskRegularly();
  void Ask();
  void SubscribeMissing();
  /// Registers the subscription at the master, and tells this node the publishers that it is not
  /// yet connected to.
  void Register(const std::string& topic);
  static std::set<std::string> ConnectedPublishers(const std::string& topic,
                                                   MasterClient& ourselves);
  /// Of these, the publishers that the master does not know.
  std::set<std::string> Orphans(const std::string& topic, const std::set<std::string>& heard,
                                const std::set<std::string>& known);
  void SetMasterAnswers(bool answers);
  void StopForGood(const std::string& reason);

  const std::vector<std::string> topics_;
  const std::string description_;
  const OnMessage on_message_;

  ros::CallbackQueue queue_;  // roscpp's threads -> the reading thread

  mutable std::mutex mutex_;  // never held during a call to the master
  std::condition_variable changed_;
  Status status_;           // guarded by mutex_
  bool has_asked_ = false;  // guarded by mutex_
  bool stopping_ = false;   // guarded by mutex_

  // Used by the separate thread only.
  MasterClient master_;
  std::string master_problem_;             // that was logged last
  std::unique_ptr<ros::NodeHandle> node_;  // null until a master has answered
  std::vector<ros::Subscriber> subscribers_;
  /// By topic: connected publishers that this master does not know, because they started before it
  /// and do not register again; and how often in a row they were not connected.
  std::map<std::string, std::map<std::string, int>> orphans_;

  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::ros_bridge
