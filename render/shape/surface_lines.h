/// Lines on a surface, as an illustrator draws them: where a function of its vertices changes its
/// sign. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/shape/line_chain.h"

namespace kinescope::render {

/// Where `values`, one per vertex and interpolated between them, are 0. On a closed surface all
/// lines are loops. `triangles`: three vertices each.
std::vector<SurfaceLine> ZeroLines(const std::vector<Eigen::Vector3f>& positions,
                                   const std::vector<std::uint32_t>& triangles,
                                   const std::vector<float>& values);

}  // namespace kinescope::render
