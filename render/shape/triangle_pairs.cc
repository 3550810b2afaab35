#include "render/shape/triangle_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace kinescope::render {
namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3f;

using TrianglePair = std::pair<std::uint32_t, std::uint32_t>;

// Boxes around runs of triangles, as a binary tree: the children of node i are 2 i and 2 i + 1.
class BoxTree {
 public:
  BoxTree(const std::vector<Vector3f>& positions, const std::vector<Vector3f>& rest,
          const std::vector<std::uint32_t>& triangles, float apart)
      : rest_(rest), triangles_(triangles), apart_(apart) {
    const std::size_t count = triangles.size() / 3;
    while (kLeaf * leaves_ < count) leaves_ *= 2;
    nodes_.resize(2 * leaves_);
    boxes_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      Node& leaf = nodes_[leaves_ + i / kLeaf];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        boxes_[i].extend(positions[triangles[3 * i + corner]]);
      }
      leaf.now.extend(boxes_[i]);
      leaf.rest.extend(rest[triangles[3 * i]]);
    }
    for (std::size_t node = leaves_ - 1; node > 0; --node) {
      for (const std::size_t child : {2 * node, 2 * node + 1}) {
        nodes_[node].now.extend(nodes_[child].now);
        nodes_[node].rest.extend(nodes_[child].rest);
      }
    }
  }

  std::vector<TrianglePair> Pairs() const {
    std::vector<TrianglePair> pairs;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{1, 1}};
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      if (!MayHavePairs(nodes_[a], nodes_[b])) continue;
      if (a >= leaves_) {
        AddPairs(a - leaves_, b - leaves_, pairs);
        continue;
      }
      open.emplace_back(2 * a, 2 * b);
      open.emplace_back(2 * a, 2 * b + 1);
      if (a != b) open.emplace_back(2 * a + 1, 2 * b);
      open.emplace_back(2 * a + 1, 2 * b + 1);
    }
    return pairs;
  }

 private:
  static constexpr std::size_t kLeaf = 8;  // triangles
  struct Node {
    AlignedBox3f now, rest;
  };

  bool MayHavePairs(const Node& a, const Node& b) const {
    return a.now.intersects(b.now) &&
           a.rest.merged(b.rest).diagonal().squaredNorm() >= apart_ * apart_;
  }

  void AddPairs(std::size_t leaf, std::size_t other, std::vector<TrianglePair>& pairs) const {
    const AlignedBox3f shared =
        nodes_[leaves_ + leaf].now.intersection(nodes_[leaves_ + other].now);
    const std::size_t end = std::min(kLeaf * (leaf + 1), boxes_.size());
    const std::size_t other_end = std::min(kLeaf * (other + 1), boxes_.size());
    std::array<std::size_t, kLeaf> near{};
    std::size_t count = 0;
    for (std::size_t b = kLeaf * other; b < other_end; ++b) {
      if (boxes_[b].intersects(shared)) near[count++] = b;
    }
    for (std::size_t a = kLeaf * leaf; count > 0 && a < end; ++a) {
      if (!boxes_[a].intersects(shared)) continue;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t b = near[i];
        if ((leaf != other || a < b) && boxes_[a].intersects(boxes_[b]) && AreApart(a, b)) {
          pairs.emplace_back(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
        }
      }
    }
  }

  bool AreApart(std::size_t a, std::size_t b) const {
    const std::uint32_t* const of_a = &triangles_[3 * a];
    const std::uint32_t* const of_b = &triangles_[3 * b];
    return (rest_[*of_a] - rest_[*of_b]).squaredNorm() >= apart_ * apart_ &&
           std::find_first_of(of_a, of_a + 3, of_b, of_b + 3) == of_a + 3;
  }

  const std::vector<Vector3f>& rest_;
  const std::vector<std::uint32_t>& triangles_;
  const float apart_;
  std::size_t leaves_ = 1;
  std::vector<Node> nodes_;
  std::vector<AlignedBox3f> boxes_;  // of the triangles
};

}  // namespace

std::vector<TrianglePair> NearPairs(const std::vector<Vector3f>& positions,
                                    const std::vector<Vector3f>& rest,
                                    const std::vector<std::uint32_t>& triangles, float apart) {
  return BoxTree(positions, rest, triangles, apart).Pairs();
}

}  // namespace kinescope::render
