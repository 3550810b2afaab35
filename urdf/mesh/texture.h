/// Pictures on the surfaces of mesh files, as colours of their vertices: every way to draw a mesh
/// has these. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "urdf/mesh/mesh.h"

namespace kinescope::urdf {

struct Texture {
  int width = 0, height = 0;       // px, > 0
  std::vector<std::uint8_t> rgba;  // (height, width, 4), top row first
};

/// Triangles with textures of a file, at most, unless it has more itself: fine enough for its
/// pictures, few enough for a page.
inline constexpr std::size_t kMostTexturedTriangles = 20'000;

/// How the pictures of a mesh file are read, and why some are not.
struct TextureReading {
  /// Of untrusted bytes. @throws std::exception with the reason
  std::function<Texture(const std::uint8_t* bytes, std::size_t size)> decode;
  std::size_t most_triangles = kMostTexturedTriangles;
  std::vector<std::string> problems = {};  // "its texture 'wood.png' is not drawn: <why>"
  std::size_t triangles = 0;               // that have textures now
};

/// Gives each vertex the colour of the texture about it, as far as the smallest triangle at it
/// reaches. Where triangles are larger than the
/// texture's pixels they are divided first, all alike, so that no gaps open between them: a picture
/// on a few triangles is as sharp as `most_triangles` allow.
/// @param uv  one per vertex: (0, 0) is the lower left corner of the texture, which repeats
/// @pre mesh.parts is empty
void PaintTexture(const Texture& texture, const std::vector<Eigen::Vector2f>& uv,
                  std::size_t most_triangles, Mesh& mesh);

}  // namespace kinescope::urdf
