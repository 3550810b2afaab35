#include "server/ros/source/told_people.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/system/utf8.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {

bool ToldPeople::Take(const std::vector<std::uint8_t>& bytes) {
  if (!ReadBounded(bytes.data(), bytes.size(), message_)) return false;
  Take(message_);
  return true;
}

void ToldPeople::Take(const kinescope_ros::PersonArray& message) {
  ++messages_;
  for (const kinescope_ros::Person& person : message.people) {
    auto known = std::find_if(told_.begin(), told_.end(), [&](const Told& told) {
      return told.message.pelvis_frame == person.pelvis_frame &&
             told.message.topics == person.topics;
    });
    if (known != told_.end()) {
      known->heard_nanos = newest_nanos_;
      known->heard_number = messages_;
    }
    if (known != told_.end() && !known->is_gone && AreEqual(known->message, person)) continue;
    if (known == told_.end()) {
      known = told_.size() < kMostPeople
                  ? told_.insert(told_.end(), Told())
                  : std::min_element(told_.begin(), told_.end(), [](const Told& a, const Told& b) {
                      return a.heard_number < b.heard_number;
                    });
    }
    *known = {person, ++revisions_, newest_nanos_, messages_, false};
  }
}

// Of two nodes that tell of the same frame, the one that told something last.
const ToldPeople::Told* ToldPeople::Find(const Person& of) {
  const Key key = key_of_(of.character.id);
  const Told* found = nullptr;
  for (Told& told : told_) {
    const kinescope_ros::Person& person = told.message;
    const bool is_meant = (!key.pelvis_frame.empty() && person.pelvis_frame == key.pelvis_frame) ||
                          (!key.topics.empty() && person.topics == key.topics);
    if (!is_meant) continue;
    told.heard_nanos = std::min(told.heard_nanos, of.newest_nanos);  // a clock may be set back
    const std::int64_t silent = of.newest_nanos - std::max(told.heard_nanos, of.since_nanos);
    told.is_gone = told.is_gone || silent > kForgetAfterNanos;
    if (!told.is_gone && (found == nullptr || told.revision > found->revision)) found = &told;
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
  const Told* const told = Find(person);
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
  constexpr std::int64_t kPauseNanos = kNanosPerSecond;
  const bool is_live = sample.arrival_nanos != 0;
  const std::int64_t now = is_live ? sample.stamp_nanos : 0;
  newest_nanos_ = now;
  const std::int64_t step = now - std::exchange(person.newest_nanos, now);
  if (std::abs(step) > kPauseNanos) person.since_nanos = now;  // or its clock was set
  const bool is_due = std::abs(now - person.looked_nanos) > kTellEveryNanos;
  if (is_due) person.looked_nanos = now;
  if (std::exchange(person.looked, revisions_) != revisions_ || is_due) {
    const Told* const told = Find(person);
    if ((told == nullptr ? 0 : told->revision) != person.revision) Give(person);
  }
  sink_->OnSample(sample);
}

bool ToldWhenTheyCame::CameJustBefore(const std::string& key, std::int64_t now_nanos) const {
  const auto came = came_.find(key);
  return came != came_.end() && now_nanos - came->second < kJustNanos;
}

void ToldWhenTheyCame::Find(const std::vector<std::uint8_t>& bytes, std::int64_t now_nanos,
                            ToldPeople& people) {
  if (!ReadBounded(bytes.data(), bytes.size(), message_)) return;
  kinescope_ros::PersonArray found;
  for (const kinescope_ros::Person& person : message_.people) {
    if (told_.size() >= ToldPeople::kMostPeople) break;
    const bool is_first = told_.emplace(person.pelvis_frame, person.topics).second;
    if (is_first && (CameJustBefore(person.pelvis_frame, now_nanos) ||
                     CameJustBefore(person.topics, now_nanos))) {
      found.people.push_back(person);
    }
  }
  if (!found.people.empty()) people.Take(found);
}

}  // namespace kinescope::ros_bridge
