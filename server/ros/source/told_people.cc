#include "server/ros/source/told_people.h"

#include <algorithm>

#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
bool ToldPeople::Take(const std::vector<std::uint8_t>& bytes) {
  if (!ReadBounded(bytes.data(), bytes.size(), message_)) return false;
  for (const kinescope_ros::Person& person : message_.people) {
    auto known = std::find_if(told_.begin(), told_.end(), [&](const Told& told) {
      return told.message.pelvis_frame == person.pelvis_frame &&
             told.message.topics == person.topics;
    });
    if (known != told_.end() && AreEqual(known->message, person)) continue;
    if (known == told_.end()) {
      if (told_.size() >= kMostPeople) continue;
      known = told_.insert(told_.end(), Told());
    }
    *known = {person, ++revisions_};
  }
  return true;
}

bool ToldPeople::Knows(const std::string& topics) const {
  return std::any_of(told_.begin(), told_.end(),
                     [&](const Told& told) { return told.message.topics == topics; });
}

// Of two nodes that tell of the same frame, the one that told something last.
const ToldPeople::Told* ToldPeople::Find(int character) const {
  const Marks marks = marks_of_(character);
  const Told* found = nullptr;
  for (const Told& told : told_) {
    const kinescope_ros::Person& person = told.message;
    const bool is_meant =
        (!marks.pelvis_frame.empty() && person.pelvis_frame == marks.pelvis_frame) ||
        (!marks.topics.empty() && person.topics == marks.topics);
    if (is_meant && (found == nullptr || told.revision > found->revision)) found = &told;
  }
  return found;
}

void ToldPeople::Give(Person& person) {
  Character character = person.character;
  if (const Told* const told = Find(character.id)) {
    person.revision = told->revision;
    character.told = ToldOf(told->message);
    // A centre of mass that is none leaves the mass at the grip.
    if (told->message.hand_load_known) {
      ReadHandLoad(told->message.hand_load, character.told_hand_load);
    }
  }
  sink_->OnCharacter(character);
}

void ToldPeople::OnCharacter(const Character& character) {
  Person& person = people_[character.id];
  person.character = character;
  Give(person);
}

void ToldPeople::OnSample(const BodySample& sample) {
  Person& person = people_[sample.character];
  person.character.id = sample.character;
  if (std::exchange(person.looked, revisions_) != revisions_) {
    const Told* const told = Find(sample.character);
    if (told != nullptr && told->revision != person.revision) Give(person);
  }
  sink_->OnSample(sample);
}

}  // namespace kinescope::ros_bridge
