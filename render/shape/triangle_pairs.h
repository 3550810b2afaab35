/// Triangles of a posed surface that may cross each other. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinescope::render {

/// Pairs that share no vertex, whose boxes overlap in `positions` and whose first vertices are at
/// least `apart` from each other in `rest`; m. Each once, in an order that depends on these
/// arguments only.
/// @param triangles three vertices each; quick if neighbours follow each other
std::vector<std::pair<std::uint32_t, std::uint32_t>> NearPairs(
    const std::vector<Eigen::Vector3f>& positions, const std::vector<Eigen::Vector3f>& rest,
    const std::vector<std::uint32_t>& triangles, float apart);

}  // namespace kinescope::render
