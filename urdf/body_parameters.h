/// Computes mass, centre of mass and inertia of each segment from sex, body mass and skeleton of a
/// person, by one of four published tables, plus added masses. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

enum class Sex { kMale, kFemale };

/// Body mass of a person whose mass is unknown, kg.
/// "male", "female".
constexpr const char* Name(Sex sex) { return sex == Sex::kMale ? "male" : "female"; }
constexpr double DefaultMass(Sex sex) { return sex == Sex::kMale ? 75 : 62; }

/// Source of the mass shares, with sections of joint-loads.md 1. Values that a table lacks are
/// taken from the default table, as body_tables.cc states row by row.
enum class BodyTable {
  kDeLeva,  // 1.5: de Leva 1996, split onto the MVN joints; agrees with MVN's own CoM within 2 mm
  kWinter,  // 1.3: Winter (Dempster), the same for both sexes
  kDumas,   // 1.2: Dumas et al. 2007 and 2015, CoMs off the bone axes
  kIit,     // 1.4: as in URDF generators for MVN subjects; trunk too heavy, head too light
};

/// A point mass that is fixed to one segment: helmet, belt, backpack, tool.
struct AddedMass {
  int segment = kPelvis;
  double mass_kg = 0;
  Eigen::Vector3d position_in_link = Eigen::Vector3d::Zero();  // in the link frame of the segment,
                                                               // m
};

constexpr std::size_t kMaxAddedMasses = 16;

struct BodyDescription {
  Sex sex = Sex::kMale;
  double mass_kg = DefaultMass(Sex::kMale);  // without added masses
  bool mass_is_assumed = true;  // the default value: every display of a load must say so
  BodyTable table = BodyTable::kDeLeva;
  std::vector<AddedMass> added_masses{};
  bool sex_is_assumed = true;  // the default value
};

struct SegmentInertia {
  double mass = 0;                                              // kg
  Eigen::Vector3d com_in_link = Eigen::Vector3d::Zero();        // m
  Eigen::Matrix3d inertia_about_com = Eigen::Matrix3d::Zero();  // kg m^2, link axes; symmetric
};

using BodyParameters = std::array<SegmentInertia, kSegmentCount>;

/// Why `body` is invalid, with the value and the expected range; "" if it is valid. Limits: a body
/// mass of 20 to 300 kg; at most kMaxAddedMasses added masses, each above 0 and at most 100 kg, on
/// an existing segment, at most 2 m from its origin.
[[nodiscard]] std::string FindDefect(const BodyDescription& body);

/// The masses add up to `body.mass_kg` (every table is divided by its own sum) plus the added
/// masses, which become part of their segments.
/// @throws std::invalid_argument with the text of FindDefect.
BodyParameters MakeBodyParameters(const BodyDescription& body, const Skeleton& skeleton);

/// kg.
double TotalMass(const BodyParameters& parameters);

const char* Name(BodyTable table);

/// "head:1.5@0,0,0.12": segment (MVN or link name), mass in kg, position in its link frame in m;
/// without @: at the origin of the segment. @throws std::invalid_argument with the text and the
/// expected form.
AddedMass ParseAddedMass(const std::string& text);

}  // namespace kinescope::urdf
