/// Keeps our topics and parameters known to a master that comes, goes and restarts. One thread of
/// its own does all the talking to the master, so that nobody else ever waits for it: roscpp is
/// started when a master first answers, and once a second the master is asked whether it still
/// knows us.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "server/core/scene_state.h"
#include "server/ros/bridge.h"
#include "server/ros/master_client.h"

namespace kinescope::ros_bridge {

/// Where one person's messages go. Publishing on them is safe from any thread.
struct PersonTopics {
  ros::Publisher joint_states, link_states, com, com_stamped, cop, markers;
  ros::Publisher tf;  // the same for all people; not valid when TF is off
};

class Announcer {
 public:
  /// `initial_urdf`: robot_description until the first person; "" for none.
  /// @pre ros::init was called.
  Announcer(std::string initial_urdf, bool with_tf);
  ~Announcer();  // takes the topics back
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;

  /// Somebody is here, or has changed. The first person's topics are `~joint_states` and so on,
  /// those of others `~<model>/joint_states`; likewise `robot_description`. Waits for nothing; any
  /// thread.
  void SetPerson(int character, std::shared_ptr<const PersonModel> model);

  /// Null until a master has answered. Waits for nothing; any thread.
  std::shared_ptr<const PersonTopics> TopicsOf(int character) const;

  /// `published` and `missed` are not its business. Any thread.
  BridgeStatus status() const;

 private:
  struct Slot {
    std::string prefix;  // "" or "<model>/"
    std::shared_ptr<const PersonModel> model;
    std::shared_ptr<const PersonTopics> topics;
  };

  void Run();
  bool WaitForNext();
  bool MasterKnowsUs(bool& answers);
  void Start();
  void AdvertiseMissing();
  std::shared_ptr<const PersonTopics> Advertise(const std::string& prefix);
  template <class Message>
  ros::Publisher Topic(const std::string& name);
  bool RegisterAll();
  void SetParameters();
  bool SetParameter(const std::string& name, const XmlRpc::XmlRpcValue& value);
  void SetReachable(bool reachable);
  void StopForGood(const char* reason);

  const std::string initial_urdf_;
  const bool with_tf_;

  mutable std::mutex mutex_;  // never held while the master is asked
  std::condition_variable changed_;
  std::map<int, Slot> slots_;                         // guarded by mutex_
  std::shared_ptr<const PersonTopics> first_topics_;  // guarded by mutex_; of whoever comes first
  BridgeStatus status_;                               // guarded by mutex_
  bool has_work_ = false;                             // guarded by mutex_
  bool stopping_ = false;                             // guarded by mutex_

  // The thread's own.
  MasterClient master_;
  std::unique_ptr<ros::NodeHandle> node_;           // private names; null before a master answered
  std::map<std::string, std::string> topic_types_;  // all that we advertised, by name
  std::set<std::string> registered_;                // of these, what this master has accepted
  std::map<std::string, std::uint64_t>
      described_;               // description parameters set, and their revision
  bool has_arguments_ = false;  // this master has our `_name:=value`
  bool was_announced_ = false;  // once, to any master

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kinescope::ros_bridge
