/// Keeps our topics and parameters known to a master that comes, goes and restarts. One thread of
/// its own does all the talking to the master, so that nobody else ever waits for it: roscpp is
/// started when a master first answers, and once a second the master is asked whether it still
/// knows us.
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_msgs/TFMessage.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/scene_state.h"
#include "server/ros/bridge.h"
#include "server/ros/force_boxes.h"
#include "server/ros/marker_topics.h"
#include "server/ros/master_client.h"
#include "server/ros/view_topics.h"

namespace kinescope::ros_bridge {

/// Where one person's messages go. Publishing on them is safe from any thread.
struct PersonTopics {
  ros::Publisher joint_states, link_states, com, com_stamped, cop, markers, joint_loads;
  ros::Publisher tf;  // the same for all people; not valid when TF is off
  std::shared_ptr<ForceBox> inputs;
};

/// Where what comes in goes. Its callbacks run on the thread that calls `queue`.
struct InputWiring {
  ros::CallbackQueue* queue = nullptr;  // outlives the announcer
  std::function<std::shared_ptr<ForceBox>()> make_box;
  std::function<void(const tf2_msgs::TFMessage&, bool is_static)> on_transforms;  // of other nodes
  std::shared_ptr<MarkerBox> markers;  // null: none are heard
  std::function<std::shared_ptr<ViewTopics>(const ros::NodeHandle&)> make_view;  // null: no view
};

class Announcer {
 public:
  /// `initial_urdf`: robot_description until the first person; "" for none.
  /// @pre ros::init was called.
  Announcer(std::string initial_urdf, bool with_tf, InputWiring wiring);
  ~Announcer();  // takes the topics back
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;

  /// Somebody is here, or has changed. The first person's topics are `~joint_states` and so on,
  /// those of others `~<model>/joint_states`; likewise `robot_description`. Waits for nothing; any
  /// thread.
  void SetPerson(int character, std::shared_ptr<const PersonModel> model);

  /// Null until a master has answered. Waits for nothing; any thread.
  std::shared_ptr<const PersonTopics> TopicsOf(int character) const;

  /// Null until a master has answered, and where there is none. Waits for nothing; any thread.
  std::shared_ptr<ViewTopics> View() const;

  /// From now on /tf and /tf_static are heard too. Waits for nothing; any thread.
  void WantTransforms();

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
  void Subscribe();
  ros::Subscriber SubscribeTransforms(const char* topic, bool is_static);
  template <class Message>
  ros::Publisher Topic(const std::string& name);
  bool RegisterAll();
  void SetParameters();
  bool SetParameter(const std::string& name, const XmlRpc::XmlRpcValue& value);
  void SetReachable(bool reachable);
  void StopForGood(const char* reason);

  const std::string initial_urdf_;
  const bool with_tf_;
  const InputWiring wiring_;

  mutable std::mutex mutex_;  // never held while the master is asked
  std::condition_variable changed_;
  std::map<int, Slot> slots_;                         // guarded by mutex_
  std::shared_ptr<const PersonTopics> first_topics_;  // guarded by mutex_; of whoever comes first
  std::shared_ptr<ViewTopics> view_;                  // guarded by mutex_
  BridgeStatus status_;                               // guarded by mutex_
  bool has_work_ = false;                             // guarded by mutex_
  bool stopping_ = false;                             // guarded by mutex_
  bool wants_transforms_ = false;                     // guarded by mutex_

  // The thread's own.
  MasterClient master_;
  std::optional<int> master_pid_;          // of the master that all that follows was said to
  std::unique_ptr<ros::NodeHandle> node_;  // private names; null before a master answered
  std::map<std::string, std::string> topic_types_;  // all that we advertised, by name
  std::set<std::string> registered_;                // of these, what this master has accepted
  std::map<std::string, std::shared_ptr<ForceBox>> boxes_;  // by prefix; all that we take in
  std::map<std::string, ForceSubscriptions> inputs_;        // of these, what this master knows of
  std::vector<ros::Subscriber> transforms_;                 // likewise
  std::vector<ros::Subscriber> markers_;                    // likewise
  std::map<std::string, std::uint64_t>
      described_;               // description parameters set, and their revision
  bool has_arguments_ = false;  // this master has our `_name:=value`
  bool was_announced_ = false;  // once, to any master

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kinescope::ros_bridge
