#include "urdf/body_parameters.h"

#include <fmt/format.h>

#include <stdexcept>

#include "urdf/body_tables.h"
#include "urdf/placed_mass.h"

namespace kinescope::urdf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLightest = 20, kHeaviest = 300;  // kg, of a person
constexpr double kMaxAddedKg = 100;
constexpr double kFarthestAddedMass = 2;  // m

struct TableName {
  const char* name;
  BodyTable table;
};
constexpr TableName kTables[] = {{"de_leva", BodyTable::kDeLeva},
                                 {"winter", BodyTable::kWinter},
                                 {"dumas", BodyTable::kDumas},
                                 {"iit", BodyTable::kIit}};

BodyShares SharesOf(const BodyDescription& body, const Skeleton& skeleton) {
  switch (body.table) {
    case BodyTable::kWinter: return WinterShares(body.sex, skeleton);
    case BodyTable::kDumas: return DumasShares(body.sex, skeleton);
    case BodyTable::kIit: return IitShares(skeleton);
    case BodyTable::kDeLeva: break;
  }
  return DeLevaShares(body.sex, skeleton);
}

// Of a point, about the origin.
Matrix3d PointInertia(double mass, const Vector3d& at) {
  return mass * (at.squaredNorm() * Matrix3d::Identity() - at * at.transpose());
}

void Add(const AddedMass& added, SegmentInertia& segment) {
  const double mass = segment.mass + added.mass_kg;
  const Vector3d com =
      (segment.mass * segment.com_in_link + added.mass_kg * added.position_in_link) / mass;
  segment.inertia_about_com += PointInertia(segment.mass, segment.com_in_link - com) +
                               PointInertia(added.mass_kg, added.position_in_link - com);
  segment.mass = mass;
  segment.com_in_link = com;
}

// By MVN or link name; -1: none.
int SegmentNamed(const std::string& name) {
  for (int i = 0; i < kSegmentCount; ++i) {
    if (kSegments[At(i)].mvn_name == name || kSegments[At(i)].link_name == name) return i;
  }
  return -1;
}

}  // namespace

std::string FindDefect(const BodyDescription& body) {
  if (!(body.mass_kg >= kLightest && body.mass_kg <= kHeaviest)) {
    return fmt::format("body mass {} kg: expected {} to {} kg", body.mass_kg, kLightest, kHeaviest);
  }
  if (body.added_masses.size() > kMaxAddedMasses) {
    return fmt::format("{} added masses: expected at most {}", body.added_masses.size(),
                       kMaxAddedMasses);
  }
  for (const AddedMass& added : body.added_masses) {
    if (added.segment < 0 || added.segment >= kSegmentCount) {
      return fmt::format("added mass on segment {}: expected 0 to {}", added.segment,
                         kSegmentCount - 1);
    }
    const std::string_view on = kSegments[At(added.segment)].link_name;
    if (!(added.mass_kg > 0 && added.mass_kg <= kMaxAddedKg)) {
      return fmt::format("added mass {} kg on {}: expected more than 0, at most {} kg",
                         added.mass_kg, on, kMaxAddedKg);
    }
    if (!(added.position_in_link.norm() <= kFarthestAddedMass)) {
      const Vector3d& at = added.position_in_link;
      return fmt::format("added mass on {} at ({}, {}, {}) m: expected within {} m of its origin",
                         on, at.x(), at.y(), at.z(), kFarthestAddedMass);
    }
  }
  return "";
}

BodyParameters MakeBodyParameters(const BodyDescription& body, const Skeleton& skeleton) {
  if (const std::string defect = FindDefect(body); !defect.empty()) {
    throw std::invalid_argument(defect);
  }
  const BodyShares shares = SharesOf(body, skeleton);
  double sum = 0;
  for (const SegmentShare& share : shares) sum += share.mass;

  BodyParameters parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double mass = body.mass_kg * shares[i].mass / sum;
    parameters[i] = {mass, shares[i].com_in_link, mass * shares[i].inertia_by_mass};
  }
  for (const AddedMass& added : body.added_masses) Add(added, parameters[At(added.segment)]);
  return parameters;
}

double TotalMass(const BodyParameters& parameters) {
  double sum = 0;
  for (const SegmentInertia& segment : parameters) sum += segment.mass;
  return sum;
}

const char* Name(BodyTable table) {
  for (const TableName& entry : kTables) {
    if (table == entry.table) return entry.name;
  }
  return "";
}

AddedMass ParseAddedMass(const std::string& text) try {
  const PlacedMass placed = ParsePlacedMass(text);
  AddedMass added;
  added.segment = SegmentNamed(placed.where);
  if (added.segment < 0) throw std::invalid_argument("unknown segment '" + placed.where + "'");
  added.mass_kg = placed.mass_kg;
  added.position_in_link = placed.position.value_or(Vector3d::Zero());
  BodyDescription body;
  body.added_masses = {added};
  if (const std::string defect = FindDefect(body); !defect.empty()) {
    throw std::invalid_argument(defect);
  }
  return added;
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format(
      "{}; expected SEGMENT:KG or SEGMENT:KG@X,Y,Z, such as head:1.5@0,0,0.12", error.what()));
}

}  // namespace kinescope::urdf
