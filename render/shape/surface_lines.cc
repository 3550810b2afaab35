#include "render/shape/surface_lines.h"

#include <array>
#include <cstddef>
#include <unordered_map>

namespace kinescope::render {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// A point on an edge of the surface, and those that a triangle joins it to.
struct Node {
  Eigen::Vector3f point;
  std::array<std::size_t, 2> beside = {kNone, kNone};
  bool is_taken = false;
};

void Join(std::vector<Node>& nodes, std::size_t a, std::size_t b) {
  const auto link = [&](std::size_t from, std::size_t to) {
    auto& beside = nodes[from].beside;
    if (beside[0] == kNone) {
      beside[0] = to;
    } else if (beside[1] == kNone) {
      beside[1] = to;
    }
  };
  link(a, b);
  link(b, a);
}

// From `first` along the links to the end.
SurfaceLine LineFrom(std::vector<Node>& nodes, std::size_t first) {
  SurfaceLine line;
  std::size_t at = first, last = first;
  while (at != kNone && !nodes[at].is_taken) {
    nodes[at].is_taken = true;
    line.points.push_back(nodes[at].point);
    const auto& beside = nodes[at].beside;
    const bool is_first_free = beside[0] != kNone && !nodes[beside[0]].is_taken;
    last = at;
    at = is_first_free ? beside[0] : beside[1];
  }
  const auto& beside = nodes[last].beside;
  line.is_loop = line.points.size() > 2 && (beside[0] == first || beside[1] == first);
  return line;
}

}  // namespace

std::vector<SurfaceLine> ZeroLines(const std::vector<Eigen::Vector3f>& positions,
                                   const std::vector<std::uint32_t>& triangles,
                                   const std::vector<float>& values) {
  std::vector<Node> nodes;
  std::unordered_map<std::uint64_t, std::size_t> on_edge;
  const auto node_on = [&](std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const std::uint64_t key = (static_cast<std::uint64_t>(a) << 32) | b;
    const auto [found, is_new] = on_edge.try_emplace(key, nodes.size());
    if (is_new) {
      const float share = values[a] / (values[a] - values[b]);
      nodes.push_back({positions[a] + share * (positions[b] - positions[a])});
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
    if (count == 2) Join(nodes, ends[0], ends[1]);
  }
  std::vector<SurfaceLine> lines;
  const auto take_from = [&](std::size_t first) {
    if (nodes[first].is_taken) return;
    SurfaceLine line = LineFrom(nodes, first);
    if (line.points.size() > 1) lines.push_back(std::move(line));
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].beside[1] == kNone) take_from(i);  // ends first, where the surface is open
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) take_from(i);
  return lines;
}

}  // namespace kinescope::render
