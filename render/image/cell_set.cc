#include "render/image/cell_set.h"

#include <algorithm>

#include "core/system/check.h"

namespace kinescope::render {
namespace {

constexpr int CellsOf(int pixels) { return (pixels + CellSet::kCell - 1) / CellSet::kCell; }

}  // namespace

CellSet::CellSet(int width, int height)
    : width_(width),
      height_(height),
      columns_(CellsOf(width)),
      rows_(CellsOf(height)),
      is_in_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void CellSet::AddEverything() { std::fill(is_in_.begin(), is_in_.end(), std::uint8_t{1}); }

void CellSet::Add(const CellSet& other) {
  KINESCOPE_CHECK(width_ == other.width_ && height_ == other.height_);
  for (std::size_t i = 0; i < is_in_.size(); ++i) is_in_[i] |= other.is_in_[i];
}

std::vector<Tile> CellSet::Rectangles() const {
  std::vector<Tile> all;
  std::vector<std::size_t> above, here;  // rectangles that end with the row above, with this row
  for (int row = 0; row < rows_; ++row) {
    here.clear();
    const int y = row * kCell, height = std::min(kCell, height_ - y);
    const auto line = is_in_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    for (int column = 0; column < columns_; ++column) {
      if (line[column] == 0) continue;
      const int first = column;
      while (column < columns_ && line[column] != 0) ++column;
      const int x = first * kCell, width = std::min(column * kCell, width_) - x;
      const auto same = std::find_if(above.begin(), above.end(), [&](std::size_t each) {
        return all[each].x == x && all[each].width == width;
      });
      if (same != above.end()) {
        all[*same].height += height;
        here.push_back(*same);
      } else {
        here.push_back(all.size());
        all.push_back({x, y, width, height});
      }
    }
    above.swap(here);
  }
  return all;
}

}  // namespace kinescope::render
