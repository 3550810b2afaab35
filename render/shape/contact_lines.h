/// Where a posed surface passes through itself: the creases between limbs that press against each
/// other, as an illustrator draws them. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/shape/line_chain.h"

namespace kinescope::render {

/// Smooth lines between parts of the surface that meet here and are apart in the rest pose: calf
/// and thigh, arm and trunk. They grow from nothing as more of the surface meets.
/// @param positions of the vertices, m
/// @param rest the same vertices in the rest pose, m
/// @param triangles three vertices each
std::vector<SurfaceLine> ContactLines(const std::vector<Eigen::Vector3f>& positions,
                                      const std::vector<Eigen::Vector3f>& rest,
                                      const std::vector<std::uint32_t>& triangles);

}  // namespace kinescope::render
