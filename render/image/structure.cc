#include "render/image/structure.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace kinescope::render {
namespace {

constexpr int kCell = LumaPlane::kCell;  // a window is 2 x 2 cells
constexpr int kCellsPerBlock = kStructureBlock / kCell;
constexpr float kPixels = 64;  // of a window

// Sums over a row of cells; integers, so exact.
struct CellRow {
  std::vector<int> expected, actual, squares, products;
};

void AddColumns(const LumaPlane& expected, const LumaPlane& actual, int cell_row, int from, int to,
                CellRow& columns) {
  const std::size_t first = static_cast<std::size_t>(from) * kCell;
  const std::size_t last = static_cast<std::size_t>(to) * kCell;
  for (auto* sums : {&columns.expected, &columns.actual, &columns.squares, &columns.products}) {
    std::fill(sums->begin() + static_cast<std::ptrdiff_t>(first),
              sums->begin() + static_cast<std::ptrdiff_t>(last), 0);
  }
  int* const sum_a = columns.expected.data();
  int* const sum_b = columns.actual.data();
  int* const squares = columns.squares.data();
  int* const products = columns.products.data();
  for (int y = cell_row * kCell; y < (cell_row + 1) * kCell; ++y) {
    const std::uint8_t* const a = expected.Row(y);
    const std::uint8_t* const b = actual.Row(y);
    for (std::size_t x = first; x < last; ++x) {
      sum_a[x] += a[x];
      sum_b[x] += b[x];
      squares[x] += a[x] * a[x] + b[x] * b[x];
      products[x] += a[x] * b[x];
    }
  }
}

void AddCells(const std::vector<int>& columns, int from, int to, std::vector<int>& cells) {
  for (int cell = from; cell < to; ++cell) {
    const int* const x = &columns[static_cast<std::size_t>(cell) * kCell];
    cells[static_cast<std::size_t>(cell)] = x[0] + x[1] + x[2] + x[3];
  }
}

// Sums over cells `from` to `to`, without `to`, of a row of cells.
void SumCells(const LumaPlane& expected, const LumaPlane& actual, int cell_row, int from, int to,
              CellRow& columns, CellRow& cells) {
  AddColumns(expected, actual, cell_row, from, to, columns);
  AddCells(columns.expected, from, to, cells.expected);
  AddCells(columns.actual, from, to, cells.actual);
  AddCells(columns.squares, from, to, cells.squares);
  AddCells(columns.products, from, to, cells.products);
}

float Similarity(int sum_a, int sum_b, int squares, int products) {
  constexpr float kC1 = 0.01F * 255 * 0.01F * 255, kC2 = 0.03F * 255 * 0.03F * 255;
  const float a = static_cast<float>(sum_a) / kPixels, b = static_cast<float>(sum_b) / kPixels;
  const float variances = static_cast<float>(squares) / kPixels - a * a - b * b;
  const float covariance = static_cast<float>(products) / kPixels - a * b;
  return (2 * a * b + kC1) * (2 * covariance + kC2) / ((a * a + b * b + kC1) * (variances + kC2));
}

// Windows whose upper cells are `above` and whose lower ones are `below`.
void Similarities(const CellRow& above, const CellRow& below, int from, int to,
                  std::vector<float>& windows) {
  const auto sum = [&](const std::vector<int>& up, const std::vector<int>& down, std::size_t i) {
    return up[i] + up[i + 1] + down[i] + down[i + 1];
  };
  for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i) {
    windows[i] =
        Similarity(sum(above.expected, below.expected, i), sum(above.actual, below.actual, i),
                   sum(above.squares, below.squares, i), sum(above.products, below.products, i));
  }
}

// The blocks whose windows meet a changed one: those at its left and above it, too.
std::vector<std::uint8_t> MeetsChange(const std::vector<std::uint8_t>& changed, int columns,
                                      int rows) {
  std::vector<std::uint8_t> meets(changed.size(), 0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (changed[static_cast<std::size_t>(row) * columns + column] == 0) continue;
      for (int y = std::max(0, row - 1); y <= row; ++y) {
        for (int x = std::max(0, column - 1); x <= column; ++x) {
          meets[static_cast<std::size_t>(y) * columns + x] = 1;
        }
      }
    }
  }
  return meets;
}

// A row of blocks: what its windows sum up to, per block.
class BlockRow {
 public:
  BlockRow(const LumaPlane& expected, const LumaPlane& actual)
      : expected_(expected), actual_(actual), windows_(WindowsAcross(expected)) {
    for (CellRow* row : {&columns_, &above_, &below_}) {
      const std::size_t size = row == &columns_ ? expected.stride : expected.stride / kCell;
      for (auto* sums : {&row->expected, &row->actual, &row->squares, &row->products}) {
        sums->resize(size);
      }
    }
  }

  /// Of blocks `from` to `to`, without `to`; `sums` are per block.
  void Sum(int block_row, int from, int to, std::vector<double>& sums) {
    const int first = from * kCellsPerBlock;
    const int last = std::min(to * kCellsPerBlock, static_cast<int>(windows_.size()));
    const int top = block_row * kCellsPerBlock;
    const int bottom = std::min(top + kCellsPerBlock, expected_.rows() - 1);
    std::fill(sums.begin(), sums.end(), 0);
    if (top >= bottom) return;
    SumCells(expected_, actual_, top, first, last + 1, columns_, above_);
    for (int row = top; row < bottom; ++row) {
      SumCells(expected_, actual_, row + 1, first, last + 1, columns_, below_);
      Similarities(above_, below_, first, last, windows_);
      for (int i = first; i < last; ++i) {
        sums[static_cast<std::size_t>(i / kCellsPerBlock)] +=
            static_cast<double>(windows_[static_cast<std::size_t>(i)]);
      }
      std::swap(above_, below_);
    }
  }

 private:
  static std::size_t WindowsAcross(const LumaPlane& plane) {
    return static_cast<std::size_t>(plane.columns() - 1);
  }

  const LumaPlane& expected_;
  const LumaPlane& actual_;
  CellRow columns_, above_, below_;
  std::vector<float> windows_;
};

int WindowsOfBlock(int block, int cells) {
  return std::clamp(cells - 1 - block * kCellsPerBlock, 0, kCellsPerBlock);
}

}  // namespace

Structure CompareStructure(const LumaPlane& expected, const LumaPlane& actual,
                           const std::vector<std::uint8_t>& changed) {
  const int columns = BlocksIn(expected.width), rows = BlocksIn(expected.height);
  const std::vector<std::uint8_t> meets = MeetsChange(changed, columns, rows);
  BlockRow block_row(expected, actual);
  std::vector<double> sums(static_cast<std::size_t>(columns) + 1);
  Structure result;
  double missing = 0;  // of all windows, to 1 each
  for (int row = 0; row < rows; ++row) {
    const auto begin = meets.begin() + static_cast<std::ptrdiff_t>(row) * columns;
    const auto end = begin + columns;
    const auto first = std::find(begin, end, 1);
    if (first == end) continue;
    const auto last =
        std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(first), 1).base();
    block_row.Sum(row, static_cast<int>(first - begin), static_cast<int>(last - begin), sums);
    for (auto block = first; block != last; ++block) {
      const int column = static_cast<int>(block - begin);
      const int windows =
          WindowsOfBlock(column, expected.columns()) * WindowsOfBlock(row, expected.rows());
      if (*block == 0 || windows == 0) continue;
      const double sum = sums[static_cast<std::size_t>(column)];
      missing += windows - sum;
      if (sum / windows >= result.worst) continue;
      result.worst = sum / windows;
      result.worst_block = Intersection(
          {column * kStructureBlock, row * kStructureBlock, kStructureBlock, kStructureBlock},
          {0, 0, expected.width, expected.height});
    }
  }
  result.mean = 1 - missing / (static_cast<double>(expected.columns() - 1) * (expected.rows() - 1));
  return result;
}

}  // namespace kinescope::render
