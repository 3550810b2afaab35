#include "server/ros/source/people_frames.h"

#include <algorithm>
#include <string_view>

#include "core/system/starts_with.h"

namespace kinescope::ros_bridge {
namespace {

using urdf::At;

constexpr std::size_t kMaxEndings = 64;  // tried per prefix; a name has as many as it has words

bool IsWordCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

// Whether text[at, at + size) is a whole word: "head" in "my_head", not in "heading".
bool IsWholeWord(std::string_view text, std::size_t at, std::size_t size) {
  const bool begins = at == 0 || !IsWordCharacter(text[at - 1]);
  const bool ends = at + size == text.size() || !IsWordCharacter(text[at + size]);
  return begins && ends;
}

// The endings of a suffix that others may share: all of it, the part after each of its words,
// nothing.
std::vector<std::string> EndingsOf(const std::string& suffix) {
  std::vector<std::string> endings = {""};
  for (std::size_t i = 0; i < suffix.size(); ++i) {
    if (!IsWordCharacter(suffix[i])) endings.push_back(suffix.substr(i));
  }
  return endings;
}

std::string Trimmed(std::string text) {
  while (!text.empty() && !IsWordCharacter(text.back())) text.pop_back();
  const auto first = std::find_if(text.begin(), text.end(), IsWordCharacter);
  text.erase(text.begin(), first);
  return text;
}

}  // namespace

bool PeopleFrames::Add(const std::string& frame) {
  if (frame.size() > kLongestName || names_.size() >= kMaxNames) return false;
  if (looked_.count(frame) > 0) return false;
  if (looked_.size() < kMaxLooked) looked_.insert(frame);
  bool is_candidate = false;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const std::string_view link = urdf::kSegments[At(segment)].link_name;
    for (std::size_t at = frame.find(link); at != std::string::npos;
         at = frame.find(link, at + 1)) {
      if (!IsWholeWord(frame, at, link.size())) continue;
      if (!is_candidate && !names_.insert(frame).second) return false;
      is_candidate = true;
      const std::string prefix = frame.substr(0, at);
      prefixes_in_order_.insert(prefix);
      by_prefix_[prefix].push_back({frame, segment, frame.substr(at + link.size())});
    }
  }
  return is_candidate;
}

void PeopleFrames::Find() {
  for (const std::string& prefix : prefixes_in_order_) {
    const std::vector<Candidate>& candidates = by_prefix_.at(prefix);
    if (candidates.size() >= urdf::kSegmentCount) FindWithPrefix(prefix, candidates);
  }
}

void PeopleFrames::FindWithPrefix(const std::string& prefix,
                                  const std::vector<Candidate>& candidates) {
  std::set<std::string> endings;
  for (const Candidate& candidate : candidates) {
    if (candidate.segment != urdf::kPelvis || endings.size() >= kMaxEndings) continue;
    for (std::string& ending : EndingsOf(candidate.suffix)) endings.insert(std::move(ending));
  }
  std::vector<std::string> longest_first(endings.begin(), endings.end());
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (const std::string& ending : longest_first) {
    if (people_.size() >= kMaxPeople) return;
    TakePerson(prefix, ending, candidates);
  }
}

bool PeopleFrames::TakePerson(const std::string& prefix, const std::string& ending,
                              const std::vector<Candidate>& candidates) {
  std::array<const Candidate*, urdf::kSegmentCount> chosen{};
  for (const Candidate& candidate : candidates) {
    if (!EndsWith(candidate.suffix, ending) || places_.count(candidate.frame) > 0) continue;
    const Candidate*& best = chosen[At(candidate.segment)];
    if (best == nullptr || candidate.suffix.size() < best->suffix.size()) best = &candidate;
  }
  if (std::count(chosen.begin(), chosen.end(), nullptr) > 0) return false;

  PersonFrames person;
  person.name = Trimmed(prefix).empty() ? Trimmed(ending) : Trimmed(prefix);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    person.frames[At(segment)] = chosen[At(segment)]->frame;
  }
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      person.frames[At(urdf::kSegmentCount + 3 * joint + axis)] =
          prefix + std::string(urdf::kJoints[At(joint)].ros_name) + "_" + "xyz"[axis] + "_link" +
          ending;
    }
  }
  const int index = static_cast<int>(people_.size());
  for (int slot = 0; slot < kFrameSlots; ++slot) {
    places_.emplace(person.frames[At(slot)], Place{index, slot});
  }
  people_.push_back(std::move(person));
  return true;
}

PeopleFrames::Place PeopleFrames::PlaceOf(const std::string& frame) const {
  const auto found = places_.find(frame);
  return found == places_.end() ? Place{} : found->second;
}

}  // namespace kinescope::ros_bridge
