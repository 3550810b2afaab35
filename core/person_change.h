/// What an operator, or the node of the suit, says about a person beside the motion. Values only;
/// any thread.
#pragma once

#include <optional>
#include <string>

#include "urdf/body_parameters.h"

namespace kinescope {

/// nullopt: as before.
struct PersonChange {
  std::optional<double> mass_kg;
  std::optional<urdf::Sex> sex;
  /// Stature, m: of the body while the stream has no segment lengths.
  std::optional<double> height_m;
  std::optional<std::string> name;

  bool is_empty() const { return !mass_kg && !sex && !height_m && !name; }

  /// What `later` sets replaces what this one sets.
  void Add(const PersonChange& later) {
    if (later.mass_kg) mass_kg = later.mass_kg;
    if (later.sex) sex = later.sex;
    if (later.height_m) height_m = later.height_m;
    if (later.name) name = later.name;
  }
};

}  // namespace kinescope
