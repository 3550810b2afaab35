/// Registers topics and parameters with the ROS master, and again after the master restarts. A
/// separate thread makes all calls to the master, so that no other thread blocks on it. It starts
/// roscpp when a master first answers, and asks the master once a second whether this node is still
/// registered.
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <bitset>
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
#include "server/ros/description_parameters.h"
#include "server/ros/force_inbox.h"
#include "server/ros/marker_topics.h"
#include "server/ros/master_client.h"
#include "server/ros/node_topics.h"
#include "server/ros/order_services.h"
#include "server/ros/refusal.h"
#include "server/ros/robot_inbox.h"
#include "server/ros/ros_camera_topics.h"

namespace kinescope::ros_bridge {

/// The publishers of one person. Any thread may publish.
struct PersonTopics {
  ros::Publisher joint_states, link_states, com, com_stamped, cop, markers, joint_loads, landmarks,
      time_code, utc;
  ros::Publisher tf;  // the same for all people; invalid if TF is off
  std::shared_ptr<ForceInbox> inputs;
};

/// What the sensors of one person's suit measure, by urdf::Segment. Any thread may publish.
struct SensorTopics {
  std::bitset<urdf::kSegmentCount> advertised;
  std::array<ros::Publisher, urdf::kSegmentCount> imu, magnetic_field;
};

/// Destinations of the input topics. The callbacks run on the thread that calls `queue`.
struct InputWiring {
  ros::CallbackQueue* queue = nullptr;  // must outlive the registration
  std::function<std::shared_ptr<ForceInbox>()> make_inbox;
  /// Of other nodes; returns why it does not use some of them.
  std::function<std::vector<Refusal>(const tf2_msgs::TFMessage&, bool is_static)> on_transforms;
  std::shared_ptr<MarkerListener> markers;               // null: no marker topics
  std::shared_ptr<RobotInbox> robots;                    // null: no robots
  std::function<void(const std::string& text)> on_mark;  // of `~mark`
  std::function<std::shared_ptr<RosCameraTopics>(const ros::NodeHandle&)>
      make_view;  // null: no view
};

class MasterRegistration {
 public:
  /// `config` must outlive the registration. @pre ros::init was called.
  MasterRegistration(const BridgeConfig& config, InputWiring wiring);
  ~MasterRegistration();  // unregisters the topics
  MasterRegistration(const MasterRegistration&) = delete;
  MasterRegistration& operator=(const MasterRegistration&) = delete;

  /// Adds a person, or updates its model. The topics of the first person are `~joint_states` and so
  /// on, those of others `~<model>/joint_states`; the URDF follows the same rule. Never blocks; any
  /// thread.
  void SetPerson(int character, std::shared_ptr<const PersonModel> model);

  /// Gives back the memory of a person who has left; the topics stay, for the person's return.
  /// Never blocks; any thread.
  void ReleasePerson(int character);

  /// Null until a master has answered. Never blocks; any thread.
  std::shared_ptr<const PersonTopics> TopicsOf(int character) const;

  /// The topics of a person's sensors: null until the master knows them. Those in `wanted` are
  /// advertised, since a suit need not send its sensors. Never blocks; any thread.
  std::shared_ptr<const SensorTopics> SensorsOf(int character,
                                                const std::bitset<urdf::kSegmentCount>& wanted);

  /// Null until a master has answered, and if there is no view. Never blocks; any thread.
  std::shared_ptr<RosCameraTopics> View() const;

  /// Null until a master has answered. Never blocks; any thread.
  std::shared_ptr<const NodeTopics> Node() const;

  /// Subscribes to /tf and /tf_static from now on. Never blocks; any thread.
  void WantTransforms();

  /// Without `published` and `missed`, which the bridge counts. Any thread.
  BridgeStatus status() const;

 private:
  struct Slot {
    std::string prefix;                        // "" or "<model>/"
    std::shared_ptr<const PersonModel> model;  // null: has left
    std::shared_ptr<const PersonTopics> topics;
    std::bitset<urdf::kSegmentCount> wanted_sensors;
    std::shared_ptr<const SensorTopics> sensors;  // null: none has come
  };

  void Run();
  void RegisterRegularly();
  bool WaitForNext();
  bool MasterKnowsUs(bool& answers);
  void Start();
  void AdvertiseMissing();
  void AdvertiseSensors();
  std::shared_ptr<const PersonTopics> Advertise(const std::string& prefix);
  void Subscribe();
  void ReadRobots();
  std::map<std::string, std::string> TypesOfHeardTopics();
  void FollowTypes();
  void LookForMissingTopics();
  void OfferOrders();
  ros::Subscriber SubscribeMarks();
  ros::Subscriber SubscribeTransforms(const char* topic, bool is_static);
  void Refuse(const char* topic, const Refusal& refusal);  // on the thread of the queue
  enum class Latch { kNo, kYes };  // whether who subscribes later hears the last message
  template <class Message>
  ros::Publisher Topic(const std::string& name, Latch latch = Latch::kNo);
  bool RegisterAll();
  void SetParameters();
  void SetReachable(bool reachable);
  void StopForGood(const char* reason);

  const BridgeConfig& config_;
  const InputWiring wiring_;

  mutable std::mutex mutex_;  // never held during a call to the master
  std::condition_variable changed_;
  std::map<int, Slot> slots_;                         // guarded by mutex_
  std::shared_ptr<const PersonTopics> first_topics_;  // guarded by mutex_; of the first person
  std::shared_ptr<RosCameraTopics> view_;             // guarded by mutex_
  std::shared_ptr<const NodeTopics> node_topics_;     // guarded by mutex_
  BridgeStatus status_;                               // guarded by mutex_
  bool has_work_ = false;                             // guarded by mutex_
  bool stopping_ = false;                             // guarded by mutex_
  bool wants_transforms_ = false;                     // guarded by mutex_

  // Used by the registration thread only.
  MasterClient master_;
  DescriptionParameters descriptions_;
  std::string master_problem_;     // that was logged last
  std::optional<int> master_pid_;  // process id of the master that the following members refer to
  std::unique_ptr<ros::NodeHandle> node_;  // private names; null until a master has answered
  std::map<std::string, std::string> topic_types_;  // all advertised topics, by name
  std::set<std::string> registered_;                // of these, those that this master has accepted
  std::map<std::string, std::shared_ptr<ForceInbox>> inboxes_;  // by prefix; all input topics
  std::map<std::string, ForceSubscriptions> inputs_;  // of these, those registered at this master
  std::vector<ros::Subscriber> transforms_;           // registered at this master
  std::vector<ros::Subscriber> markers_;              // registered at this master
  std::int64_t markers_since_nanos_ = 0;
  std::map<std::string, std::string> heard_types_;  // of their topics, by name, as of the master
  std::int64_t types_asked_nanos_ = 0;              // monotonic clock
  bool has_looked_for_topics_ = false;
  std::vector<ros::Subscriber> joint_states_;  // registered at this master
  std::int64_t robots_due_nanos_ = 0;          // monotonic clock
  std::optional<ros::Subscriber> marks_;       // registered at this master
  std::unique_ptr<OrderServices> orders_;      // null until a master has answered
  bool orders_are_offered_ = false;            // at this master
  bool has_arguments_ = false;     // the `_name:=value` parameters were set at this master
  bool was_registered_ = false;    // registered at least once, at any master
  bool master_forgot_us_ = false;  // and still does: then it is not said each time

  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::ros_bridge
