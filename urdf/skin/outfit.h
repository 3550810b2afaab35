/// What the person wears: borders between colours, as signed distances, so that they are crisp at
/// any zoom. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

/// How far a vertex is inside of each, m, within +-kFarthestBorder: trousers, bare skin (head and
/// hands), shoes, bands around chest and upper arms.
struct Borders {
  float trousers = 0, bare = 0, shoes = 0, bands = 0;
};
inline constexpr float kFarthestBorder = 0.05f;

/// Of each vertex of `skin`.
std::vector<Borders> OutfitOf(const SkinTemplate& skin, const Build& build);

/// Whether a border goes through the triangle, or less than 2 mm beside it: its softness is less.
/// @param suit OutfitOf(), or empty: no borders
bool HasBorder(const std::vector<Borders>& suit, const Triangle& triangle);

}  // namespace kinescope::skin
