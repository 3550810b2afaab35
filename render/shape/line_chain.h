/// Joins the pieces of lines to whole lines. One thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace kinescope::render {

/// `is_loop`: the last point is joined to the first.
struct SurfaceLine {
  std::vector<Eigen::Vector3f> points;  // as the surface, m
  bool is_loop = false;
};

class LineChain {
 public:
  /// @return the index of a new point
  std::size_t Add(const Eigen::Vector3f& point);
  /// A point has two neighbours at most; further ones are ignored.
  void Join(std::size_t a, std::size_t b);
  /// The lines of at least two points, in the order of their first points: open ones, then loops.
  /// Nothing is left.
  std::vector<SurfaceLine> Take();

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Node {
    Eigen::Vector3f point;
    std::array<std::size_t, 2> beside = {kNone, kNone};
    bool is_taken = false;
  };
  SurfaceLine LineFrom(std::size_t first);

  std::vector<Node> nodes_;
};

}  // namespace kinescope::render
