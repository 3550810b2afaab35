/// Mass, centre of mass and inertia of each segment, from the person's sex, mass and skeleton.
/// Table: joint-loads.md 1.5 (de Leva 1996, split onto the MVN joints).
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

enum class Sex { kMale, kFemale };

struct BodyDescription {
  Sex sex = Sex::kMale;
  double mass_kg = 75.0;
  bool mass_is_assumed = true;  // nobody said it: say so wherever a load is shown
};

struct SegmentInertia {
  double mass = 0;                                              // kg
  Eigen::Vector3d com_in_link = Eigen::Vector3d::Zero();        // m
  Eigen::Vector3d inertia_about_com = Eigen::Vector3d::Zero();  // kg m^2, diagonal, link axes
};

using BodyParameters = std::array<SegmentInertia, kSegmentCount>;

/// Masses add up to `body.mass_kg` (the table is divided by its own sum).
/// @throws std::invalid_argument unless 20 <= mass_kg <= 300.
BodyParameters MakeBodyParameters(const BodyDescription& body, const Skeleton& skeleton);

/// kg.
double TotalMass(const BodyParameters& parameters);

/// "male" or "female". @throws std::invalid_argument naming the value.
Sex ParseSex(const std::string& text);

}  // namespace kinescope::urdf
