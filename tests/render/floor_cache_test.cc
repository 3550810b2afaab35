// Which floors are kept, and for how long.
#include "render/vtk/floor_cache.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/vtk/held_size.h"

namespace kinescope::render {
namespace {

class Floors {
 public:
  explicit Floors(std::size_t most_bytes = FloorCache::kMostBytes) : cache(most_bytes) {}

  /// Draws the floor `number`. @return whether it had to be drawn.
  bool Draw(int number, int width = 8, int height = 8) {
    const FloorCache::Key key = {static_cast<double>(number)};
    const Tile tile{1, 2, width, height};
    SetSize(image_, width + 3, height + 3);
    std::fill(image_.rgba.begin(), image_.rgba.end(), std::uint8_t{0});
    const SharedPixels found = cache.Find(key);
    if (found != nullptr) {
      CopyFloor(*found, tile, tile, image_);
      EXPECT_EQ(CountOf(number), 4 * width * height) << "bytes of the floor " << number;
      EXPECT_EQ(First(tile), number) << "at its place";
    } else {
      std::fill(image_.rgba.begin(), image_.rgba.end(), static_cast<std::uint8_t>(number));
      cache.Keep(key, tile, image_);
    }
    return found == nullptr;
  }

  /// How many of `count` floors were drawn, one after the other.
  int DrawAll(int count, int width = 8, int height = 8) {
    int drawn = 0;
    for (int i = 1; i <= count; ++i) drawn += Draw(i, width, height) ? 1 : 0;
    return drawn;
  }

  FloorCache cache;

 private:
  int CountOf(int value) const {
    return static_cast<int>(std::count(image_.rgba.begin(), image_.rgba.end(), value));
  }
  int First(const Tile& tile) const {
    return image_.rgba[4 * static_cast<std::size_t>(tile.y * image_.width + tile.x)];
  }
  Image image_;
};

TEST(FloorCache, KeepsThoseOfAllViewsFromTheSecondPictureOn) {
  Floors floors;
  EXPECT_EQ(floors.DrawAll(12), 12);
  EXPECT_EQ(floors.cache.bytes(), 0U) << "a camera that moves pays for no copy";
  EXPECT_EQ(floors.DrawAll(12), 12);
  for (int picture = 0; picture < 20; ++picture) EXPECT_EQ(floors.DrawAll(12), 0);
  EXPECT_EQ(floors.cache.bytes(), 12U * 4 * 8 * 8);
}

TEST(FloorCache, CopiesAPartToItsPlace) {
  const Tile tile{10, 20, 6, 4}, part{12, 21, 3, 2};
  std::vector<std::uint8_t> floor(4 * 6 * 4);
  for (std::size_t i = 0; i < floor.size(); ++i) floor[i] = static_cast<std::uint8_t>(1 + i);
  Image image;
  SetSize(image, 40, 30);
  CopyFloor(floor, tile, part, image);
  const auto at = [&](int x, int y) {
    return image.rgba[4 * static_cast<std::size_t>(y * image.width + x)];
  };
  EXPECT_EQ(at(12, 21), floor[4 * (6 + 2)]);
  EXPECT_EQ(at(14, 22), floor[4 * (2 * 6 + 4)]);
  EXPECT_EQ(image.rgba.size() - static_cast<std::size_t>(std::count(
                                    image.rgba.begin(), image.rgba.end(), std::uint8_t{0})),
            4U * 3 * 2);
}

TEST(FloorCache, ForgetsThoseOfFormerCameras) {
  Floors floors;
  for (int picture = 0; picture < 3; ++picture) floors.Draw(1);
  for (std::uint64_t i = 0; i <= FloorCache::kLongest; ++i) floors.Draw(2 + static_cast<int>(i));
  EXPECT_EQ(floors.cache.bytes(), 0U);
  EXPECT_TRUE(floors.Draw(1));
}

TEST(FloorCache, IsBoundedAndKeepsAPartOfWhatIsTooMuch) {
  constexpr std::size_t kFit = 4, kBytes = 4 * 8 * 8;
  Floors floors(kFit * kBytes + 1);
  floors.DrawAll(kFit + 2);
  floors.DrawAll(kFit + 2);
  EXPECT_EQ(floors.cache.bytes(), kFit * kBytes);
  EXPECT_EQ(floors.DrawAll(kFit + 2), 2) << "they do not drive each other out";
}

TEST(FloorCache, TakesThePlaceOfWhatIsNoLongerUsed) {
  constexpr int kSide = 16;
  Floors floors(std::size_t{4} * kSide * kSide);
  for (int picture = 0; picture < 3; ++picture) floors.Draw(1, kSide, kSide);
  EXPECT_TRUE(floors.Draw(2));
  EXPECT_TRUE(floors.Draw(2));
  EXPECT_FALSE(floors.Draw(2));
  EXPECT_TRUE(floors.Draw(1, kSide, kSide));
}

TEST(HeldSize, StaysForTheTilesOfAPictureAndBecomesSmallerAfterIt) {
  HeldSize size;
  for (int picture = 0; picture < 100; ++picture) {
    size.Need(4096, 2880);
    size.Need(1024, 2880);
    ASSERT_EQ(size.width(), 4096) << "picture " << picture;
  }
  for (int i = 0; i < 2 * HeldSize::kLongest; ++i) size.Need(640, 360);
  EXPECT_EQ(size.width(), 640);
  EXPECT_EQ(size.height(), 360);
}

}  // namespace
}  // namespace kinescope::render
