/// Tells pixels of smoothed (anti-aliased) edges from others: rasterisers of two machines disagree
/// there first. Pure function, any thread.
/// Source: Vysniauskas (2009), Anti-aliased pixel and intensity slope detector, Elektronika ir
/// Elektrotechnika 95(7), 107-110.
#pragma once

#include "render/image/image.h"
#include "render/image/luma.h"

namespace kinescope::render {

/// Two pictures of one size, opaque, with their luma.
struct PicturePair {
  const Image& expected;
  const Image& actual;
  const LumaPlane& expected_luma;
  const LumaPlane& actual_luma;
};

/// Whether the pixel lies on a smoothed edge of one of the pictures: it has at most two neighbours
/// of its luma, brighter and darker ones, and the brightest or the darkest of them belongs to an
/// area of one colour in both pictures.
bool IsOnSmoothedEdge(const PicturePair& pair, int x, int y);

}  // namespace kinescope::render
