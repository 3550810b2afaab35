#include "render/image/cell_set.h"

#include <gtest/gtest.h>

#include <vector>

namespace kinescope::render {
namespace {

// Which pixels of a picture of 50 x 37 px the rectangles cover, and that none is covered twice.
std::vector<int> Covered(const CellSet& cells) {
  std::vector<int> count(50 * 37);
  for (const Tile& tile : cells.Rectangles()) {
    EXPECT_FALSE(IsEmpty(tile));
    EXPECT_GE(tile.x, 0);
    EXPECT_GE(tile.y, 0);
    EXPECT_LE(tile.x + tile.width, 50);
    EXPECT_LE(tile.y + tile.height, 37);
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        EXPECT_EQ(count[static_cast<std::size_t>(50 * y + x)]++, 0);
      }
    }
  }
  return count;
}

int Sum(const std::vector<int>& count) {
  int sum = 0;
  for (const int each : count) sum += each;
  return sum;
}

TEST(CellSet, HasTheSquaresThatATileTouches) {
  CellSet cells(50, 37);
  EXPECT_TRUE(cells.Rectangles().empty());
  cells.Add({15, 16, 2, 1});
  const std::vector<int> count = Covered(cells);
  EXPECT_EQ(Sum(count), 32 * 16);
  EXPECT_EQ(count[50 * 16 + 0], 1);
  EXPECT_EQ(count[50 * 31 + 31], 1);
  EXPECT_EQ(count[50 * 15 + 15], 0);
}

TEST(CellSet, EndsWithThePicture) {
  CellSet cells(50, 37);
  cells.Add({48, 33, 100, 100});
  EXPECT_EQ(Sum(Covered(cells)), 2 * 5);
  for (const Tile& outside : {Tile{-5, 0, 5, 5}, Tile{50, 0, 5, 5}, Tile{0, 37, 5, 5},
                              Tile{0, -3, 5, 3}, Tile{3, 3, 0, 9}, Tile{3, 3, 9, -1}}) {
    cells.Add(outside);
  }
  EXPECT_EQ(Sum(Covered(cells)), 2 * 5);
  cells.AddEverything();
  EXPECT_EQ(Sum(Covered(cells)), 50 * 37);
  EXPECT_EQ(cells.Rectangles().size(), 1U);
}

TEST(CellSet, AddsAnotherSet) {
  CellSet cells(50, 37), other(50, 37);
  cells.Add({0, 0, 1, 1});
  other.Add({0, 0, 17, 1});
  other.Add({40, 20, 1, 1});
  cells.Add(other);
  EXPECT_EQ(Covered(cells), Covered(other));
}

}  // namespace
}  // namespace kinescope::render
