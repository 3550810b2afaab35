#include "render/shape/line_chain.h"

#include <utility>

namespace kinescope::render {

std::size_t LineChain::Add(const Eigen::Vector3f& point) {
  nodes_.push_back({point});
  return nodes_.size() - 1;
}

void LineChain::Join(std::size_t a, std::size_t b) {
  const auto link = [&](std::size_t from, std::size_t to) {
    auto& beside = nodes_[from].beside;
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
SurfaceLine LineChain::LineFrom(std::size_t first) {
  SurfaceLine line;
  std::size_t at = first, last = first;
  while (at != kNone && !nodes_[at].is_taken) {
    nodes_[at].is_taken = true;
    line.points.push_back(nodes_[at].point);
    const auto& beside = nodes_[at].beside;
    const bool is_first_free = beside[0] != kNone && !nodes_[beside[0]].is_taken;
    last = at;
    at = is_first_free ? beside[0] : beside[1];
  }
  const auto& beside = nodes_[last].beside;
  line.is_loop = line.points.size() > 2 && (beside[0] == first || beside[1] == first);
  return line;
}

std::vector<SurfaceLine> LineChain::Take() {
  std::vector<SurfaceLine> lines;
  const auto take_from = [&](std::size_t first) {
    if (nodes_[first].is_taken) return;
    SurfaceLine line = LineFrom(first);
    if (line.points.size() > 1) lines.push_back(std::move(line));
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].beside[1] == kNone) take_from(i);  // ends first
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) take_from(i);
  nodes_.clear();
  return lines;
}

}  // namespace kinescope::render
