/// Numbers and masses at places, as people type them: "head:1.5@0,0,0.12". Any thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace kinescope::urdf {

struct PlacedMass {
  std::string where;  // before the colon; never empty
  double mass_kg = 0;
  std::optional<Eigen::Vector3d> position;  // m
};

/// Reads WHERE:KG or WHERE:KG@X,Y,Z. Numbers are finite; whether they make sense is the caller's.
/// @throws std::invalid_argument naming the part of `text` that is wrong.
PlacedMass ParsePlacedMass(const std::string& text);

/// Numbers with commas between, each finite. @throws std::invalid_argument naming what is none.
std::vector<double> ParseNumbers(const std::string& text);

}  // namespace kinescope::urdf
