/// One person's transforms, as /tf gives them one by one, to samples. Bounded memory; one thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>

#include "core/body_sample.h"
#include "server/ros/people_frames.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

/// One transform of the person, checked: finite, and a unit quaternion.
struct FrameTransform {
  int slot = 0;          // of its child frame, see PeopleFrames
  int parent_slot = -1;  // -1: the parent is none of the person's frames
  std::string parent;    // its name
  urdf::Pose parent_from_child;
  std::int64_t header_nanos = 0;
  std::int64_t record_nanos = 0;  // when it came: to the bag, or to us
};

class TransformPerson {
 public:
  enum class Result {
    kNothing,    // the set is not whole yet
    kSample,     // see sample()
    kDuplicate,  // a whole set with the stamp of the one before
    kNoTree,     // a whole set whose frames hang on different ones, or in a circle
  };

  explicit TransformPerson(int id) { sample_.character = id; }

  /// True when `transform` begins the next set, and so ends one that lacks segments.
  bool Add(const FrameTransform& transform);
  /// From /tf_static: part of every set to come that does not bring the frame itself.
  void AddStatic(const FrameTransform& transform);
  /// Call when all transforms of a message were added. `arrival_nanos`: as in BodySample.
  [[nodiscard]] Result Finish(std::int64_t arrival_nanos = 0);
  /// Nothing more will come: true when a set was left that lacks segments.
  [[nodiscard]] bool End() const { return HasSegments(); }

  const BodySample& sample() const { return sample_; }
  /// Times that the stamp in the headers was earlier than that of the sample before.
  std::uint64_t steps_back() const { return steps_back_; }

 private:
  using Poses = std::array<urdf::Pose, urdf::kSegmentCount>;

  bool HasSegments() const;
  const FrameTransform* Find(int slot) const;  // null: not there
  /// Poses relative to the frame on which the whole set hangs: kSample, kNothing or kNoTree.
  Result Chain(Poses& poses) const;
  void FindArmFrames(const Poses& poses);
  std::int64_t StampInHeaders() const;
  /// False when the set is the sample before once more.
  [[nodiscard]] bool SetStamp(std::int64_t header_nanos, std::int64_t record_nanos);
  void SetSegments(const Poses& poses);

  // The set that is being collected.
  std::array<FrameTransform, kFrameSlots> pending_;
  std::bitset<kFrameSlots> present_;
  std::int64_t first_record_nanos_ = 0;

  std::array<FrameTransform, kFrameSlots> static_;  // for good
  std::bitset<kFrameSlots> is_static_;

  BodySample sample_;  // the newest
  std::uint32_t samples_ = 0;
  std::uint64_t steps_back_ = 0;
  std::int64_t first_stamp_ = 0;
  std::int64_t last_header_nanos_ = 0;
  bool headers_are_right_ = true;
  std::optional<bool> arms_are_turned_;  // link frames; unknown until a sample tells
};

}  // namespace kinescope::ros_bridge
