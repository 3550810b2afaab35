#include "render/image/clusters.h"

#include <algorithm>
#include <utility>

namespace kinescope::render {

ClusterFinder::ClusterFinder(int width, int height)
    : columns_((width + kCell - 1) / kCell),
      rows_((height + kCell - 1) / kCell),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void ClusterFinder::Add(int x, int y) {
  Cell& cell = cells_[static_cast<std::size_t>(y / kCell) * columns_ + x / kCell];
  if (cell.pixels++ == 0) {
    cell.left = cell.right = x;
    cell.top = cell.bottom = y;
    return;
  }
  cell.left = std::min(cell.left, x);
  cell.right = std::max(cell.right, x);
  cell.top = std::min(cell.top, y);
  cell.bottom = std::max(cell.bottom, y);
}

// Empties the cells that it has collected.
Cluster ClusterFinder::Collect(int column, int row) {
  Cluster cluster;
  Cell all = cells_[static_cast<std::size_t>(row) * columns_ + column];
  std::vector<std::pair<int, int>> open = {{column, row}};
  while (!open.empty()) {
    const auto [at_column, at_row] = open.back();
    open.pop_back();
    const Cell cell =
        std::exchange(cells_[static_cast<std::size_t>(at_row) * columns_ + at_column], {});
    if (cell.pixels == 0) continue;  // collected meanwhile
    cluster.pixels += cell.pixels;
    all.left = std::min(all.left, cell.left);
    all.top = std::min(all.top, cell.top);
    all.right = std::max(all.right, cell.right);
    all.bottom = std::max(all.bottom, cell.bottom);
    for (int y = std::max(0, at_row - 1); y <= std::min(rows_ - 1, at_row + 1); ++y) {
      for (int x = std::max(0, at_column - 1); x <= std::min(columns_ - 1, at_column + 1); ++x) {
        if (cells_[static_cast<std::size_t>(y) * columns_ + x].pixels > 0) open.emplace_back(x, y);
      }
    }
  }
  cluster.box = {all.left, all.top, all.right - all.left + 1, all.bottom - all.top + 1};
  return cluster;
}

std::vector<Cluster> ClusterFinder::Take() {
  std::vector<Cluster> clusters;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * columns_ + column;
      if (cells_[at].pixels > 0) clusters.push_back(Collect(column, row));
    }
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.pixels > b.pixels; });
  return clusters;
}

}  // namespace kinescope::render
