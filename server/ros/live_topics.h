/// Hears topics of a running ROS graph, through masters that are not there yet, die or are
/// restarted. roscpp registers a subscription once, waits for a master while it does, and never
/// asks again; so one thread of its own starts roscpp when a master first answers, and tells the
/// master once a second that we listen. The reading thread only takes what has come.
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
  using Event = ros::MessageEvent<const RawMessage>;
  using OnMessage = std::function<void(std::size_t topic, const Event& event)>;

  struct Status {
    bool master_answers = false;  // when last asked; asked once a second
    std::size_t publishers = 0;   // connected, of all topics
    bool told_to_stop = false;    // `rosnode kill`, or another node took our name: nothing comes
  };

  /// Begins to listen to `topics`, which are resolved names; `on_message` gets their index.
  /// `description`: whose log lines these are.
  /// @pre ros::init was called.
  LiveTopics(std::vector<std::string> topics, std::string description, OnMessage on_message);
  /// Ends our node, where no bridge has done so before.
  ~LiveTopics();
  LiveTopics(const LiveTopics&) = delete;
  LiveTopics& operator=(const LiveTopics&) = delete;

  /// Waits at most `timeout` for messages and hands on what came. One thread calls it.
  void Take(std::chrono::milliseconds timeout);
  Status status() const;  // any thread

 private:
  void Run();
  void Ask();
  void Start();
  /// Tells the master that we listen, and our own node who publishes what it does not hear yet.
  void Register(const std::string& topic);
  static std::set<std::string> ConnectedPublishers(const std::string& topic,
                                                   MasterClient& ourselves);
  /// Of these, whom the master does not know.
  std::set<std::string> Orphans(const std::string& topic, const std::set<std::string>& heard,
                                const std::set<std::string>& known);
  void SetMasterAnswers(bool answers);
  void StopForGood();

  const std::vector<std::string> topics_;
  const std::string description_;
  const OnMessage on_message_;

  ros::CallbackQueue queue_;  // roscpp's threads -> the reading thread

  mutable std::mutex mutex_;  // never held while the master is asked
  std::condition_variable changed_;
  Status status_;           // guarded by mutex_
  bool has_asked_ = false;  // guarded by mutex_
  bool stopping_ = false;   // guarded by mutex_

  // The thread's own.
  MasterClient master_;
  std::unique_ptr<ros::NodeHandle> node_;  // null before a master answered
  std::vector<ros::Subscriber> subscribers_;
  /// By topic: publishers that we hear and this master does not know, because they were there
  /// before it and do not tell it; and how often in a row they were then not heard.
  std::map<std::string, std::map<std::string, int>> orphans_;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kinescope::ros_bridge
