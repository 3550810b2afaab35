/// GLSL of the skin: a suit, loads around the joints, and the light on them.
#pragma once

#include <vector>

#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

struct SkinShading {
  bool is_lit_at_vertices = false;  // enough where triangles are a few pixels wide
  bool has_loads = false;           // shows loads as regions of the skin
  bool is_flat = false;             // without light, for drawings of lines
  bool is_suit = true;              // else each vertex has a colour
  bool has_borders = false;         // the colour of the suit changes within a triangle

  bool operator<(const SkinShading& other) const;
};

/// Uniforms of all: `topColor`, `trousersColor`, `shoesColor`, `bareColor`, `bandColor`,
/// `overrideColor` (rgb, share), `opacityFactor`. With loads, by region (skin::RegionOf):
/// `regionLook` (rgb; from how far inside the region begins, 2: hidden), `regionRim` (as the rim of
/// a load sphere; negative: also hatched).
ShaderText SkinText(const SkinShading& shading);
/// What `SkinText` reads: `paint` (borders of the suit or a colour), `openSky` and, with loads,
/// `region` (inside, joint, place across the hatching in m).
std::vector<VertexAttribute> SkinAttributes(const SkinShading& shading);

}  // namespace kinescope::render
