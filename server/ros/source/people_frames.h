/// Finds the TF frames of body segments by their names. Kinescope's are `<model>_<link>`; others
/// add more to the link name ("l5_abdomen_down_xsens"), and a robot in the same graph may have a
/// "left_hand", too. Pure; one thread.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "urdf/segments.h"

namespace kinescope::ros_bridge {

/// Frames of one person by slot: the 23 segments, then the links inside joints that Kinescope's
/// tree has (transforms.h): three per joint, by axis.
inline constexpr int kFrameSlots = urdf::kSegmentCount + 3 * urdf::kJointCount;

struct PersonFrames {
  std::string name;  // for display: "skeleton"; for "head_xsens", "neck_xsens" ...: "xsens"
  std::array<std::string, kFrameSlots> frames;
};

class PeopleFrames {
 public:
  static constexpr std::size_t kMaxPeople = 16;
  static constexpr std::size_t kMaxNames =
      4096;  // frame names that contain a segment's name; further ones are ignored
  static constexpr std::size_t kLongestName = 255;  // bytes; longer names are ignored

  /// Adds a frame name without a leading '/'. True if it is new and may be a segment.
  bool Add(const std::string& frame);

  bool IsCandidate(const std::string& frame) const { return names_.count(frame) > 0; }

  /// Searches the added names for people: sets of 23 frames, one per segment, with the same prefix
  /// and the same suffix. Of several such suffixes the longest is used, of several frames for a
  /// segment the shortest. People found before stay unchanged, with their index.
  void Find();

  const std::vector<PersonFrames>& people() const { return people_; }

  struct Place {
    int person = -1;  // index of people(); -1: of no person
    int slot = -1;
  };
  Place PlaceOf(const std::string& frame) const;

 private:
  struct Candidate {
    std::string frame;
    int segment = 0;
    std::string suffix;
  };

  void FindWithPrefix(const std::string& prefix, const std::vector<Candidate>& candidates);
  bool TakePerson(const std::string& prefix, const std::string& ending,
                  const std::vector<Candidate>& candidates);

  static constexpr std::size_t kMaxLooked = 50'000;  // as TfTree::kMostFrameNames

  std::unordered_set<std::string> looked_;  // names that were added: most come again and again
  std::set<std::string> names_;             // candidates
  std::unordered_map<std::string, std::vector<Candidate>> by_prefix_;
  std::set<std::string> prefixes_in_order_;  // sorted, so that people have the same numbers in
                                             // every run
  std::vector<PersonFrames> people_;
  std::unordered_map<std::string, Place> places_;
};

}  // namespace kinescope::ros_bridge
