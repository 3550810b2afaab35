/// Parses masses with positions and lists of numbers as users type them: "head:1.5@0,0,0.12". Pure
/// functions, any thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace kinescope::urdf {

struct PlacedMass {
  std::string where;  // text before the colon; never empty
  double mass_kg = 0;
  std::optional<Eigen::Vector3d> position;  // m; absent without @
};

/// Reads WHERE:KG or WHERE:KG@X,Y,Z. Numbers are finite; the caller checks their range. @throws
/// std::invalid_argument with the invalid part of `text`.
PlacedMass ParsePlacedMass(const std::string& text);

/// Reads comma-separated finite numbers. @throws std::invalid_argument with the invalid part.
std::vector<double> ParseNumbers(const std::string& text);

}  // namespace kinescope::urdf
