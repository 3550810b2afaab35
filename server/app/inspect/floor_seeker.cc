#include "server/app/inspect/floor_seeker.h"

#include <algorithm>
#include <memory>

namespace kinescope::app {

FloorSeeker::FloorSeeker()
    : builder_({}, "", 0, [this](const std::shared_ptr<const SceneState>& state) {
        for (const PersonState& person : state->people) {
          floors_[person.character] = {person.forces.floor_z, person.forces.why_no_floor};
        }
      }) {}

void FloorSeeker::OnDatagram(const mvn::ReceivedDatagram& datagram) {
  assembler_.Expire(datagram.arrival.monotonic_nanos, *this);
  assembler_.Add(datagram.from, datagram.bytes, datagram.arrival, *this);
}

void FloorSeeker::Fill(mvn::InspectionReport& report) {
  assembler_.Flush(*this);
  for (mvn::CharacterReport& character : report.characters) {
    if (character.kind != mvn::CharacterKind::kPerson) continue;
    mvn::FloorReport& floor = character.floor.emplace();
    const auto senders =
        std::count_if(report.characters.begin(), report.characters.end(),
                      [&](const mvn::CharacterReport& other) { return other.id == character.id; });
    const auto found = floors_.find(character.id);
    if (senders > 1) {
      floor.why_not = "several senders use this character id";
    } else if (found == floors_.end()) {
      floor.why_not = "the recording has no complete sample of the person";
    } else {
      floor = {found->second.height, std::string(found->second.why_not)};
    }
  }
}

}  // namespace kinescope::app
