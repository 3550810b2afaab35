#include "server/app/serve/change_notes.h"

#include <fmt/format.h>

namespace kinescope::app {
namespace {

std::string Kilograms(double mass) { return fmt::format("{:g} kg", mass); }

std::string PercentText(const std::array<double, 2>& limits) {
  return fmt::format("{:g} % and {:g} %", 100 * limits[0], 100 * limits[1]);
}

}  // namespace

const PersonState* FindPerson(const SceneState* state, int character) {
  for (std::size_t i = 0; state != nullptr && i < state->people.size(); ++i) {
    if (state->people[i].character == character) return &state->people[i];
  }
  return nullptr;
}

std::string NameOf(const PersonState& person) {
  return person.name.empty() ? "person " + std::to_string(person.character) : person.name;
}

std::string NameOf(const SceneState* state, int character) {
  const PersonState* const person = FindPerson(state, character);
  return person != nullptr ? NameOf(*person) : std::to_string(character);
}

HandLoad StatedHandLoadOf(const SceneState* state, int character) {
  const PersonState* const person = FindPerson(state, character);
  return person != nullptr ? person->forces.stated_hand_load : HandLoad();
}

void NoteChange(OperatorLog& log, std::string_view role, const PersonState& person,
                const PersonChange& stated, const PersonChange& change) {
  const PersonModel& model = *person.model;
  const std::string who = NameOf(person);
  const urdf::BodyDescription& body = model.description;
  if (change.mass_kg) {
    log.Note(role, "mass of " + who, Kilograms(stated.mass_kg.value_or(body.mass_kg)),
             Kilograms(*change.mass_kg));
  }
  if (change.sex) {
    log.Note(role, "sex of " + who, Name(stated.sex.value_or(body.sex)), Name(*change.sex));
  }
  if (change.height_m) {
    const double before = stated.height_m.value_or(model.human.skeleton.height);
    log.Note(role, "stature of " + who, fmt::format("{:.3g} m", before),
             fmt::format("{:.3g} m", *change.height_m));
  }
  if (change.name) {
    log.Note(role, "name of person " + std::to_string(person.character), who, *change.name);
  }
}

void NoteClassLimits(OperatorLog& log, std::string_view role, const std::array<double, 2>& before,
                     const std::array<double, 2>& after) {
  log.Note(role, "class limits", PercentText(before), PercentText(after));
}

}  // namespace kinescope::app
