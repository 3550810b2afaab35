/// Finds the frames in which forces are measured: the reference frame, a link of the person, or any
/// frame in /tf. One thread.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/scene_state.h"
#include "server/ros/names.h"
#include "server/ros/refusal.h"

namespace kinescope::ros_bridge {

/// A frame and what it hangs on, by their names.
struct TreeFrame {
  std::string name;
  std::string parent;             // "": it hangs on none
  std::int64_t newest_nanos = 0;  // stamp of its newest transform; 0: it always holds
};

/// Where a frame is at a time.
struct FramePlace {
  urdf::Pose pose;        // target_from_frame
  bool is_early = false;  // by its newest transform, which is older than that time
};

inline std::optional<urdf::Pose> PoseOf(const std::optional<FramePlace>& place) {
  return place ? std::make_optional(place->pose) : std::nullopt;
}

/// Frames published by other nodes, kept for ten seconds. Kinescope's own frames are not included:
/// they are known from the newest sample, and tf2 would ignore them after a recording starts over.
class TfTree {
 public:
  static constexpr std::size_t kMostFrameNames = 50'000;  // transforms of further ones are refused

  TfTree();

  /// Adds the transforms of a message. Skips those that are invalid (a number that is not finite,
  /// an invalid quaternion) or older than all that are kept, and returns why: one for each kind. If
  /// nothing else comes of a frame, or only what is half a second older than its newest, time was
  /// set back, as by a bag in a loop: what was kept of it is forgotten then.
  std::vector<Refusal> Add(const tf2_msgs::TFMessage& message, bool is_static);

  /// The clock of the graph was set back to `now_nanos`: forgets, as RViz, what was kept of moving
  /// frames until now, but not of the new time, which may be here already.
  void StartAgain(std::int64_t now_nanos);

  /// Whether `frame` is among those of other nodes.
  bool Knows(const std::string& frame) const { return buffer_._frameExists(frame); }

  /// All of which something was heard, and their parents, by name, in no order.
  const std::unordered_map<std::string, TreeFrame>& frames() const { return frames_; }

  /// Why the transforms of a frame that is not among them were skipped, as "with a number that is
  /// not finite"; "": none has come, or it is among them.
  std::string WhySkipped(const std::string& frame) const;

  /// target_from_frame at `stamp_nanos`, or the newest if that time is unknown.
  std::optional<FramePlace> Find(const std::string& target, const std::string& frame,
                                 std::int64_t stamp_nanos) const;

 private:
  /// Null: it is taken.
  const char* Take(const geometry_msgs::TransformStamped& transform, bool is_static);

  struct Moving {
    geometry_msgs::TransformStamped newest;
    int too_old_in_a_row = 0;  // refused since
    int behind_in_a_row = 0;   // come since, but much older
    int round = 0;             // round_ when it was last continued
  };

  /// tf2 can only forget all moving frames: those that `stays` holds for get their newest transform
  /// again, and lose the ten seconds before it.
  template <class Stays>
  void ForgetUnless(const Stays& stays);
  void SetBack();
  bool IsSetBack(Moving& moving, const ros::Time& stamp);
  void Note(const std::string& frame, const geometry_msgs::TransformStamped& transform);

  int round_ = 0;  // times that time was set back by less than tf2 keeps
  tf2::BufferCore buffer_;
  std::unordered_map<std::string, TreeFrame> frames_;     // by name, as tf2 has them
  std::unordered_map<std::string, Moving> moving_;        // those that are not static
  std::unordered_map<std::string, const char*> skipped_;  // why, by name, of the first ones
};

/// The person at the sensors, as in the newest sample. World frame, metres.
struct BodyNow {
  urdf::LinkPoses links{};  // world_from_link
  urdf::Skeleton skeleton;
  double floor_z = 0;
  std::int64_t stamp_nanos = 0;
};

struct FoundFrame {
  urdf::Pose pose;  // world_from_frame
  /// The reference frame or a link of the person: its origin is not the position of a sensor.
  bool is_own = false;
  bool is_early = false;  // as FramePlace has it
};

/// `frame` as a link of `model` ("skeleton_right_hand", "right_hand", "RightHand"), as the
/// reference frame, or as a frame in `tf` that is connected to one of them; nullopt otherwise.
std::optional<FoundFrame> FindFrame(const std::string& frame, std::int64_t stamp_nanos,
                                    const std::string& reference_frame, const std::string& model,
                                    const BodyNow& body, const TfTree& tf);

}  // namespace kinescope::ros_bridge
