#include "server/ros/source/told_people.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/system/utf8.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
bool ToldPeople::Take(const std::vector<std::uint8_t>& bytes, std::int64_t now_nanos) {
  if (!ReadBounded(bytes.data(), bytes.size(), message_)) return false;
  for (const kinescope_ros::Person& person : message_.people) {
    auto known = std::find_if(told_.begin(), told_.end(), [&](const Told& told) {
      return told.message.pelvis_frame == person.pelvis_frame &&
             told.message.topics == person.topics;
    });
    if (known != told_.end()) known->heard_nanos = now_nanos;
    if (known != told_.end() && AreEqual(known->message, person)) continue;
    if (known == told_.end()) {
      if (told_.size() >= kMostPeople) continue;
      known = told_.insert(told_.end(), Told());
    }
    *known = {person, ++revisions_, now_nanos};
  }
  return true;
}

void ToldPeople::Forget(std::int64_t now_nanos) {
  constexpr std::int64_t kPauseNanos = kNanosPerSecond;
  const std::int64_t paused = now_nanos - std::exchange(looked_nanos_, now_nanos);
  for (auto told = told_.begin(); told != told_.end();) {
    if (paused > kPauseNanos) told->heard_nanos = now_nanos;
    const bool is_gone = now_nanos - told->heard_nanos > kForgetAfterNanos;
    if (is_gone) ++revisions_;
    told = is_gone ? told_.erase(told) : std::next(told);
  }
}

// Of two nodes that tell of the same frame, the one that told something last.
const ToldPeople::Told* ToldPeople::Find(int character) const {
  const Key key = key_of_(character);
  const Told* found = nullptr;
  for (const Told& told : told_) {
    const kinescope_ros::Person& person = told.message;
    const bool is_meant = (!key.pelvis_frame.empty() && person.pelvis_frame == key.pelvis_frame) ||
                          (!key.topics.empty() && person.topics == key.topics);
    if (is_meant && (found == nullptr || told.revision > found->revision)) found = &told;
  }
  return found;
}

void ToldPeople::Say(const std::string& name, const kinescope_ros::Person* told) {
  constexpr int kMostLines = 100;
  if (++said_ > kMostLines) return;
  std::vector<std::string> parts;
  if (told != nullptr && !std::isnan(told->body_mass)) {
    parts.push_back(fmt::format("body mass {:.4g} kg", told->body_mass));
  }
  const std::optional<urdf::Sex> sex = told != nullptr ? ToldOf(*told).sex : std::nullopt;
  if (sex) parts.emplace_back(Name(*sex));
  if (told != nullptr && told->hand_load_known) {
    const auto& held = told->hand_load;
    const double all_kg = held.right_kg + held.left_kg + held.both_kg;
    parts.push_back(all_kg > 0 ? fmt::format("{:.4g} kg in the hands", all_kg) : "empty hands");
  }
  spdlog::info("'{}', as the node of the suit says: {}", PrintableLine(name),
               parts.empty() ? "nothing any more" : fmt::format("{}", fmt::join(parts, ", ")));
}

void ToldPeople::Give(Person& person) {
  Character character = person.character;
  const Told* const told = Find(character.id);
  const std::uint64_t revision = told == nullptr ? 0 : told->revision;
  const bool has_something =
      told != nullptr && !(ToldOf(told->message).is_empty() && !told->message.hand_load_known);
  if (revision != person.revision && (has_something || person.has_something)) {
    Say(character.name, told == nullptr ? nullptr : &told->message);
  }
  person.has_something = has_something;
  person.revision = revision;
  if (told != nullptr) {
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
    if ((told == nullptr ? 0 : told->revision) != person.revision) Give(person);
  }
  sink_->OnSample(sample);
}

}  // namespace kinescope::ros_bridge
