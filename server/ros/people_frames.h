/// Which TF frames are the segments of people, told by their names alone. Ours are
/// `<model>_<link>`; others put more around the link's name ("l5_abdomen_down_xsens"), and a robot
/// beside them may have a "left_hand" of its own. Pure; one thread.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "urdf/segments.h"

namespace kinescope::ros_bridge {

/// Frames of one person by slot: the 23 segments, then the links inside joints that our tree has
/// (transforms.h): three for each joint, by axis.
inline constexpr int kFrameSlots = urdf::kSegmentCount + 3 * urdf::kJointCount;

struct PersonFrames {
  std::string name;  // for people: "skeleton"; of "head_xsens", "neck_xsens" ...: "xsens"
  std::array<std::string, kFrameSlots> frames;
};

class PeopleFrames {
 public:
  static constexpr std::size_t kMostPeople = 16;
  static constexpr std::size_t kMostNames =
      4096;  // with a segment's name in them; more are not looked at
  static constexpr std::size_t kLongestName = 255;  // likewise

  /// A frame's name without a leading '/'. True when it is new and might be a segment.
  bool Add(const std::string& frame);

  bool IsCandidate(const std::string& frame) const { return names_.count(frame) > 0; }

  /// Looks for people among what was added: sets of 23 frames, one for each segment, that begin
  /// alike and end alike. Of several such endings the longest counts, of several frames for a
  /// segment the shortest. People once found stay as they are, with their place.
  void Find();

  const std::vector<PersonFrames>& people() const { return people_; }

  struct Place {
    int person = -1;  // index of people(); -1: nobody's
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

  std::set<std::string> names_;  // candidates, so that each is looked at once
  std::unordered_map<std::string, std::vector<Candidate>> by_prefix_;
  std::set<std::string> prefixes_in_order_;  // so that people are numbered alike in every run
  std::vector<PersonFrames> people_;
  std::unordered_map<std::string, Place> places_;
};

}  // namespace kinescope::ros_bridge
