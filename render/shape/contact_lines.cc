#include "render/shape/contact_lines.h"

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <tuple>

#include "render/shape/smooth_line.h"
#include "render/shape/triangle_pairs.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kApart = 0.045f;           // m, in the rest pose
constexpr double kShortestContact = 0.03;  // m
constexpr double kContactWave = 0.06;      // m

// Where the edge from `p` to `q` passes through the triangle; the order of its vertices does not
// matter.
bool Crosses(const Vector3f& p, const Vector3f& q, const std::array<Vector3f, 3>& triangle,
             Vector3f& at) {
  const Vector3d from = p.cast<double>(), along = q.cast<double>() - from;
  std::array<Vector3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = triangle[i].cast<double>() - from;
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double of_p = -normal.dot(corners[0]), of_q = of_p + normal.dot(along);
  if ((of_p < 0) == (of_q < 0)) return false;
  std::array<bool, 3> is_left{};
  for (std::size_t i = 0; i < 3; ++i) {
    is_left[i] = corners[i].cross(corners[(i + 1) % 3]).dot(along) < 0;
  }
  if (is_left[0] != is_left[1] || is_left[1] != is_left[2]) return false;
  at = (from + of_p / (of_p - of_q) * along).cast<float>();
  return true;
}

}  // namespace

std::vector<SurfaceLine> ContactLines(const std::vector<Vector3f>& positions,
                                      const std::vector<Vector3f>& rest,
                                      const std::vector<std::uint32_t>& triangles) {
  LineChain chain;
  // By edge and the triangle that it passes through.
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::size_t> points;
  const auto add_crossings = [&](std::uint32_t of, std::uint32_t through, std::size_t* ends,
                                 std::size_t& count) {
    const std::uint32_t* const edges = &triangles[3 * of];
    const std::uint32_t* const face = &triangles[3 * through];
    const std::array<Vector3f, 3> corners = {positions[face[0]], positions[face[1]],
                                             positions[face[2]]};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(edges[i], edges[(i + 1) % 3]);
      Vector3f at;
      if (count == 2 || !Crosses(positions[a], positions[b], corners, at)) continue;
      const auto [found, is_new] = points.try_emplace({a, b, through}, 0);
      if (is_new) found->second = chain.Add(at);
      ends[count++] = found->second;
    }
  };
  for (const auto& [a, b] : NearPairs(positions, rest, triangles, kApart)) {
    std::size_t ends[2], count = 0;
    add_crossings(a, b, ends, count);
    add_crossings(b, a, ends, count);
    if (count == 2) chain.Join(ends[0], ends[1]);
  }
  std::vector<SurfaceLine> lines;
  for (const SurfaceLine& line : chain.Take()) {
    if (LengthOf(line) >= kShortestContact) lines.push_back(Smoothed(line, kContactWave));
  }
  return lines;
}

}  // namespace kinescope::render
