/// Assembles one person's transforms, as /tf contains them, to samples. Memory is limited; one
/// thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>

#include "core/body_sample.h"
#include "server/ros/source/people_frames.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

/// One transform of the person, checked: finite, with a unit quaternion.
struct FrameTransform {
  int slot = 0;          // of its child frame; see PeopleFrames
  int parent_slot = -1;  // -1: the parent is not a frame of the person
  std::string parent;    // name of the parent
  urdf::Pose parent_from_child;
  std::int64_t header_nanos = 0;
  std::int64_t record_nanos = 0;  // time at which the bag recorded or this node received it
};

/// Whether the stamp of a header may be that of a message that was recorded, or received, then.
[[nodiscard]] bool IsOfRecordTime(std::int64_t header_nanos, std::int64_t record_nanos);

/// What the samples of all people of a source are counted from: who comes later goes on where the
/// others are.
struct SampleOrigin {
  std::optional<std::int64_t> stamp_nanos;  // of time code 0; none: no sample yet
  std::uint32_t counter = 0;                // of the newest sample
};

class TransformPerson {
 public:
  enum class Result {
    kNothing,    // the set is not complete yet
    kSample,     // see sample()
    kDuplicate,  // a complete set with the stamp of the one before
    kNoTree,     // a complete set whose frames have different roots, or form a cycle
  };

  using Slots = std::bitset<kFrameSlots>;

  explicit TransformPerson(int id) { sample_.character = id; }

  /// Call it before the transforms of a message are added. `slots`: theirs. True if they begin the
  /// next set although the current one lacks segments: what was left of that would cut a whole set
  /// in two.
  [[nodiscard]] bool Begin(const Slots& slots);
  /// True if `transform` begins the next set although the current one lacks segments.
  bool Add(const FrameTransform& transform);
  /// Adds a frame of /tf_static: part of every later set that does not contain it itself.
  void AddStatic(const FrameTransform& transform);
  /// Call it after all transforms of a message were added. `arrival_nanos`: as in BodySample.
  [[nodiscard]] Result Finish(std::int64_t arrival_nanos, SampleOrigin& origin);
  /// End of the input: true if a set that lacks segments is left.
  [[nodiscard]] bool End() const { return HasSegments(); }

  const BodySample& sample() const { return sample_; }
  /// The frame that the sample is in; "" before the first one.
  const std::string& root() const { return root_; }
  /// Number of times that the header stamp was earlier than that of the sample before.
  std::uint64_t steps_back() const { return steps_back_; }

 private:
  using Poses = std::array<urdf::Pose, urdf::kSegmentCount>;

  bool HasSegments() const;
  const FrameTransform* Find(int slot) const;  // null: none
  /// Poses relative to the root frame of the set: kSample, kNothing or kNoTree.
  Result Chain(Poses& poses, const std::string*& root) const;
  void FindArmFrames(const Poses& poses);
  std::int64_t StampInHeaders() const;
  /// False if the set is a repetition of the sample before.
  [[nodiscard]] bool SetStamp(std::int64_t header_nanos, std::int64_t record_nanos,
                              SampleOrigin& origin);
  void StartOver(std::int64_t header_nanos, std::int64_t record_nanos);
  void SetSegments(const Poses& poses);

  // The set that is being collected.
  std::array<FrameTransform, kFrameSlots> pending_;
  Slots present_;
  std::int64_t first_record_nanos_ = 0;

  std::array<FrameTransform, kFrameSlots> static_;  // kept for all sets
  Slots is_static_;

  BodySample sample_;  // the newest
  std::string root_;
  std::uint32_t samples_ = 0, first_counter_ = 0;
  std::uint64_t steps_back_ = 0;
  std::int64_t first_stamp_ = 0;
  std::int64_t last_header_nanos_ = 0;
  std::int64_t last_record_nanos_ = 0;
  bool headers_are_right_ = true;
  std::optional<bool> arms_are_turned_;  // link frames; unset until a sample decides
};

}  // namespace kinescope::ros_bridge
