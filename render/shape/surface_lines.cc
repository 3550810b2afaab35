#include "render/shape/surface_lines.h"

#include <array>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace kinescope::render {
std::vector<SurfaceLine> ZeroLines(const std::vector<Eigen::Vector3f>& positions,
                                   const std::vector<std::uint32_t>& triangles,
                                   const std::vector<float>& values) {
  LineChain chain;
  std::unordered_map<std::uint64_t, std::size_t> on_edge;
  const auto node_on = [&](std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const std::uint64_t key = (static_cast<std::uint64_t>(a) << 32) | b;
    const auto [found, is_new] = on_edge.try_emplace(key, 0);
    if (is_new) {
      const float share = values[a] / (values[a] - values[b]);
      found->second = chain.Add(positions[a] + share * (positions[b] - positions[a]));
    }
    return found->second;
  };
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    std::array<std::size_t, 2> ends{};
    std::size_t count = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = triangles[i + corner], b = triangles[i + (corner + 1) % 3];
      if ((values[a] < 0) == (values[b] < 0)) continue;
      ends[count++] = node_on(a, b);
    }
    if (count == 2) chain.Join(ends[0], ends[1]);
  }
  return chain.Take();
}

}  // namespace kinescope::render
