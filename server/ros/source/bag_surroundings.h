/// What a bag has beside the people, as it changes over time: markers (visualization_msgs/Marker
/// and MarkerArray, on any topic), messages that are shown as markers, and robots. Actions,
/// lifetimes and frames are as in marker_input.h, by the times of the bag. One thread.
#pragma once

#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/source.h"
#include "server/ros/followed_frame.h"
#include "server/ros/force_frames.h"
#include "server/ros/image_box.h"
#include "server/ros/marker_input.h"
#include "server/ros/robot_frames.h"
#include "server/ros/shown_frames.h"
#include "server/ros/source/bag_reader.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {

/// Once in a process: a clip reads a bag twice.
void WarnOfBag(const std::string& bag, const std::string& text);

class BagSurroundings {
 public:
  /// @throws UsageError for a frame whose axes cannot be shown
  explicit BagSurroundings(const GraphView& view);
  BagSurroundings(const BagSurroundings&) = delete;
  BagSurroundings& operator=(const BagSurroundings&) = delete;

  /// Whether a view that names its topic shows its messages.
  static bool CanBeShown(const BagConnection& connection);
  /// Whether its messages are used.
  bool IsUsed(const BagConnection& connection) const;

  /// What is ignored of them, in SourceCounters.
  static constexpr char kOwnMarkers[] = "markers of Kinescope";
  /// Nothing that is shown has come.
  bool IsEmpty() const {
    return store_.markers().empty() && robots_.empty() && images_.images().empty() &&
           frames_.empty();
  }

  /// The frame of the first thing that is shown; "": there is none yet.
  std::string FirstFrame() const { return store_.FirstFrame(); }
  /// Whether WarnOfProblems() tells what is counted as `defect`.
  bool HasNamed(const std::string& defect) const { return named_.count(defect) > 0; }
  /// Whether something of TF is to be shown: all frames, the axes of some, or robots.
  bool ShowsFrames() const { return shows_frames_ || !robots_.empty(); }
  /// Whether topics are named.
  bool HasTopics() const { return !heard_.empty(); }
  /// The bag has something that is shown.
  void Expect() { has_markers_ = true; }
  /// Whether there is a marker, an image or a robot, with or without a place.
  bool HasSomething() const {
    return !robots_.empty() || !FirstFrame().empty() || !images_.images().empty();
  }

  /// Takes a message of such a connection. What is not used is counted by reason: the markers that
  /// Kinescope itself published, which a scene draws by itself, in `ignored`. @pre IsUsed()
  void Take(const BagMessage& message, SourceCounters& counters);
  /// Remembers frames; before there is something to place the static ones alone.
  void AddTransforms(const tf2_msgs::TFMessage& message, const std::string& topic, bool is_static);
  /// Delivers all to `sink` if something has changed at `now_nanos` (of the bag). `world`: the
  /// frame of the scene. Warns once of each frame that is not there.
  void Update(std::int64_t now_nanos, const std::string& world, const std::string& bag,
              SampleSink& sink);

  /// Says which links of robots are nowhere; once per program, although a bag is read for a clip
  /// twice, and again in every round of --loop.
  /// And what was not shown of the topics that are named.
  void WarnOfProblems(const std::string& bag, const std::string& world) const;

 private:
  struct Robot {
    RobotFrames frames;
    std::string joint_states;  // topic
  };

  struct Heard {
    std::size_t shown = 0;
    bool has_colors = false;
  };

  const char* Decode(const BagMessage& message);
  static std::string LackOf(const BagMessage& message);
  void ForgetLack(const std::string& key);
  void TakeMarkers(const BagMessage& message, SourceCounters& counters);
  void TakeShown(const ShownTopic& topic, std::size_t number, const BagMessage& message,
                 SourceCounters& counters);
  void TakeImage(const ShownTopic& topic, std::size_t number, const BagMessage& message,
                 SourceCounters& counters);
  void TakeCalibration(std::size_t number, const BagMessage& message, SourceCounters& counters);
  void TakeColors(std::size_t number, const BagMessage& message, SourceCounters& counters);
  void TakeJointStates(const BagMessage& message, SourceCounters& counters);
  /// Counts what is not shown of a topic, and remembers why.
  void Reject(const BagMessage& message, const Refusal& refusal, SourceCounters& counters);
  void Note(const std::string& what, const Refusal& refusal);
  /// The number of a topic; nullopt, counted: there are too many. What is shown of one topic in
  /// several ways has a number each.
  std::optional<std::size_t> NumberOf(const std::string& topic, SourceCounters& counters);
  std::optional<std::size_t> NumberOf(std::size_t shown, SourceCounters& counters);
  /// What tells the messages of one shown topic from those of others, also of the same name.
  std::string SenderOf(std::size_t shown) const;
  std::vector<const RobotFrames*> Frames() const;
  bool PlaceRobots(std::int64_t now_nanos, const std::string& world);

  const std::vector<ShownTopic> shown_topics_;  // their names have slashes
  /// Places in shown_topics_, by the name of a topic that is heard for them.
  std::multimap<std::string, Heard> heard_;
  bool leaves_out_others_ = false;  // markers of topics that are not named
  std::vector<Robot> robots_;
  bool has_new_robots_ = true;
  std::optional<std::int64_t> placed_nanos_;
  bool has_markers_ = false, has_scenes_on_images_ = false;
  MarkerStore store_;
  ShownJoints joints_;
  TopicMarkers shown_{[this](const std::string& joint) { return joints_.Find(joint); }};
  ImageBox images_;
  FollowedFrame camera_frame_;
  std::vector<ShownFrames> frames_;
  TfTree tf_;
  std::map<std::string, std::size_t> topics_;    // their numbers
  std::set<std::string> lost_frames_;            // that were warned of
  std::set<std::string> heard_topics_;           // those that a message came on
  std::map<std::string, std::string> rejected_;  // the first one, by topic and kind
  std::set<std::string> lacks_;  // beginnings of keys of rejected_: of what may still come
  bool shows_frames_ = false;
  std::set<std::string> named_;  // as they are counted
  visualization_msgs::Marker marker_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace kinescope::ros_bridge
