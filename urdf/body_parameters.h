/// Mass, centre of mass and inertia of each segment, from the person's sex, mass and skeleton, by
/// one of four published tables, plus what the person wears.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

enum class Sex { kMale, kFemale };

/// Where the shares of mass come from. All are joint-loads.md 1; what a table lacks is taken from
/// the default one, as body_tables.cc says row by row.
enum class BodyTable {
  kDeLeva,  // 1.5: de Leva 1996, split onto the MVN joints; agrees with MVN's own CoM within 2 mm
  kWinter,  // 1.3: Winter (Dempster), the same for both sexes
  kDumas,   // 1.2: Dumas et al. 2007 and 2015, CoMs off the bones' axes
  kIit,     // 1.4: that of URDF generators for MVN subjects; trunk too heavy, head too light
};

/// Worn or carried, rigidly on one segment: helmet, belt, backpack, tool.
struct ExtraMass {
  int segment = kPelvis;
  double mass_kg = 0;
  Eigen::Vector3d position_in_link = Eigen::Vector3d::Zero();  // of its CoM, m; it is a point
};

constexpr std::size_t kMostExtraMasses = 16;

struct BodyDescription {
  Sex sex = Sex::kMale;
  double mass_kg = 75.0;        // without extra masses
  bool mass_is_assumed = true;  // nobody said it: say so wherever a load is shown
  BodyTable table = BodyTable::kDeLeva;
  std::vector<ExtraMass> extra_masses{};
  bool sex_is_assumed = true;  // as for the mass
};

struct SegmentInertia {
  double mass = 0;                                              // kg
  Eigen::Vector3d com_in_link = Eigen::Vector3d::Zero();        // m
  Eigen::Matrix3d inertia_about_com = Eigen::Matrix3d::Zero();  // kg m^2, link axes; symmetric
};

using BodyParameters = std::array<SegmentInertia, kSegmentCount>;

/// "" or what is wrong with `body`, naming the value and what is expected: a body mass outside 20
/// to 300 kg; an extra mass that is not above 0 and at most 100 kg, that is farther than 2 m from
/// its segment's origin, on a segment that does not exist, or one of more than kMostExtraMasses.
[[nodiscard]] std::string FindDefect(const BodyDescription& body);

/// Masses add up to `body.mass_kg` (every table is divided by its own sum) and the extra masses,
/// which are part of their segments.
/// @throws std::invalid_argument with FindDefect's text.
BodyParameters MakeBodyParameters(const BodyDescription& body, const Skeleton& skeleton);

/// kg.
double TotalMass(const BodyParameters& parameters);

/// "male" or "female". @throws std::invalid_argument naming the value.
Sex ParseSex(const std::string& text);

/// "de_leva", "winter", "dumas" or "iit". @throws std::invalid_argument naming the value.
BodyTable ParseBodyTable(const std::string& text);
const char* Name(BodyTable table);

/// "head:1.5@0,0,0.12": segment (MVN or link name), kg, and where, in its link frame, m; without @:
/// at the segment's origin. @throws std::invalid_argument naming the text and what is expected.
ExtraMass ParseExtraMass(const std::string& text);

}  // namespace kinescope::urdf
