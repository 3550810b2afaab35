#include "urdf/mesh/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace kinescope::urdf {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr int kMostSamples = 8;  // of a vertex, along each side of the square about it

int Wrapped(double pixel, int size) {
  const double share = pixel / size - std::floor(pixel / size);
  return std::min(static_cast<int>(share * size), size - 1);
}

// The mean of a square of `side` px about the place.
Vector4f ColorAbout(const Texture& texture, const Vector2f& uv, double side) {
  if (!uv.allFinite()) return Vector4f::Ones();
  const double x = static_cast<double>(uv.x()) * texture.width;
  const double y = (1 - static_cast<double>(uv.y())) * texture.height;
  const int count = static_cast<int>(std::clamp(side, 1.0, 1.0 * kMostSamples));
  std::array<int, 3> sum = {};
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < count; ++k) {
      const auto at = [&](double middle, int n) {
        return middle + side * ((n + 0.5) / count - 0.5);
      };
      const auto column = static_cast<std::size_t>(Wrapped(at(x, i), texture.width));
      const auto row = static_cast<std::size_t>(Wrapped(at(y, k), texture.height));
      const std::uint8_t* const pixel =
          &texture.rgba[4 * (row * static_cast<std::size_t>(texture.width) + column)];
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += pixel[c];
    }
  }
  Vector4f color = Vector4f::Ones();
  for (std::size_t c = 0; c < sum.size(); ++c) {
    color[static_cast<Eigen::Index>(c)] =
        static_cast<float>(sum[c]) / (255.0F * static_cast<float>(count * count));
  }
  return color;
}

// Of each triangle the length of its longest edge, px of the texture.
std::vector<double> EdgesPx(const Texture& texture, const std::vector<Vector2f>& uv,
                            const Mesh& mesh) {
  std::vector<double> edges;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector2f edge = uv[mesh.triangles[i + (k + 1) % 3]] - uv[mesh.triangles[i + k]];
      const double px = std::hypot(static_cast<double>(edge.x()) * texture.width,
                                   static_cast<double>(edge.y()) * texture.height);
      if (std::isfinite(px)) longest = std::max(longest, px);
    }
    edges.push_back(longest);
  }
  return edges;
}

// Of each vertex the least of its triangles.
std::vector<double> SidesPx(const std::vector<double>& edges, const Mesh& mesh) {
  std::vector<double> sides(mesh.positions.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    double& side = sides[mesh.triangles[i]];
    side = std::min(side, edges[i / 3]);
  }
  return sides;
}

// A triangle as parts * parts ones, whose corners on an edge are the same from both of its sides.
class Divider {
 public:
  Divider(const Mesh& from, const std::vector<Vector2f>& uv, int parts)
      : from_(from), uv_(uv), parts_(parts) {}

  // @param edge_px  the longest one, in the texture
  void Add(std::size_t first, double edge_px) {
    std::array<std::uint32_t, 3> corners;
    std::copy_n(from_.triangles.begin() + static_cast<std::ptrdiff_t>(first), 3, corners.begin());
    const auto begin = static_cast<std::uint32_t>(to.positions.size());
    for (int row = 0; row <= parts_; ++row) {
      for (int column = 0; column <= row; ++column) {
        AddPoint(corners, parts_ - row, row - column, column);
        sides_px.push_back(edge_px / parts_);
      }
    }
    const auto at = [&](int row, int column) {
      return begin + static_cast<std::uint32_t>(row * (row + 1) / 2 + column);
    };
    for (int row = 0; row < parts_; ++row) {
      for (int column = 0; column <= row; ++column) {
        to.AddTriangle(at(row, column), at(row + 1, column), at(row + 1, column + 1));
        if (column == row) continue;
        to.AddTriangle(at(row, column), at(row + 1, column + 1), at(row, column + 1));
      }
    }
  }

  Mesh to;
  std::vector<Vector2f> uv_to;
  std::vector<double> sides_px;  // of each vertex

 private:
  void AddPoint(const std::array<std::uint32_t, 3>& corners, int a, int b, int c) {
    const auto between = [&](const auto& values) {
      const auto parts = static_cast<float>(parts_);
      return ((static_cast<float>(a) * values[corners[0]] +
               static_cast<float>(b) * values[corners[1]] +
               static_cast<float>(c) * values[corners[2]]) /
              parts)
          .eval();
    };
    const Vector3f normal = between(from_.normals);
    const float norm = normal.norm();
    to.AddVertex(between(from_.positions),
                 norm > 0 ? Vector3f(normal / norm) : from_.normals[corners[0]]);
    uv_to.push_back(between(uv_));
  }

  const Mesh& from_;
  const std::vector<Vector2f>& uv_;
  const int parts_;
};

}  // namespace

void PaintTexture(const Texture& texture, const std::vector<Vector2f>& uv,
                  std::size_t most_triangles, Mesh& mesh) {
  const std::size_t triangles = mesh.triangles.size() / 3;
  if (triangles == 0) return;
  const std::vector<double> edges = EdgesPx(texture, uv, mesh);
  const double longest = *std::max_element(edges.begin(), edges.end());
  const double most =
      std::floor(std::sqrt(static_cast<double>(most_triangles) / static_cast<double>(triangles)));
  const int parts = static_cast<int>(std::clamp(std::ceil(longest), 1.0, std::max(1.0, most)));
  Divider divided(mesh, uv, parts);
  std::vector<double> sides = parts > 1 ? std::vector<double>() : SidesPx(edges, mesh);
  if (parts > 1) {
    for (std::size_t i = 0; i < triangles; ++i) divided.Add(3 * i, edges[i]);
    mesh = std::move(divided.to);
    sides = std::move(divided.sides_px);
  }
  const std::vector<Vector2f>& places = parts > 1 ? divided.uv_to : uv;
  mesh.colors.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    mesh.colors.push_back(ColorAbout(texture, places[i], sides[i]));
  }
}

}  // namespace kinescope::urdf
