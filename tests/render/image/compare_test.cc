#include "render/image/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/resample.h"

namespace kinescope::render {
namespace {

Image GreyPicture(int width, int height, std::uint8_t level = 100) {
  Image image{width, height, {}};
  image.rgba.resize(static_cast<std::size_t>(4 * width * height), level);
  return image;
}

std::uint8_t& Channel(Image& image, int x, int y, int channel) {
  return image.rgba[static_cast<std::size_t>(4 * (y * image.width + x) + channel)];
}

TEST(Compare, IgnoresTwoLevelsAndReportsThree) {
  const Image expected = GreyPicture(8, 6);
  Image actual = expected;
  Channel(actual, 3, 2, 1) = 102;
  EXPECT_TRUE(Compare(expected, actual).equal());
  EXPECT_EQ(Compare(expected, actual).largest_difference, 2);
  Channel(actual, 3, 2, 1) = 103;
  EXPECT_FALSE(Compare(expected, actual).equal());
  Channel(actual, 3, 2, 1) = 97;
  EXPECT_EQ(Compare(expected, actual).pixels, 1);
}

TEST(Compare, ReportsTheNumberAndPlaceOfDifferentPixels) {
  const Image expected = GreyPicture(20, 10);
  Image actual = expected;
  Channel(actual, 4, 7, 0) = 0;
  Channel(actual, 15, 3, 2) = 177;
  const Comparison comparison = Compare(expected, actual);
  EXPECT_EQ(comparison.pixels, 2);
  EXPECT_EQ(comparison.left, 4);
  EXPECT_EQ(comparison.right, 15);
  EXPECT_EQ(comparison.top, 3);
  EXPECT_EQ(comparison.bottom, 7);
  EXPECT_EQ(comparison.largest_difference, 100);
  EXPECT_EQ(Describe(comparison, actual),
            "2 pixels differ (1.00 %), in x 4..15, y 3..7, by up to 100 levels");
}

TEST(Compare, ReportsADifferentSize) {
  const Comparison comparison = Compare(GreyPicture(8, 6), GreyPicture(6, 8));
  EXPECT_FALSE(comparison.equal());
  EXPECT_FALSE(comparison.same_size);
  EXPECT_THAT(Describe(comparison, GreyPicture(6, 8)), ::testing::HasSubstr("6 x 8"));
}

TEST(Compare, ShowsDifferencesInRedOnAPalePicture) {
  const Image expected = GreyPicture(4, 4, 30);
  Image actual = expected;
  Channel(actual, 1, 2, 0) = 200;
  Image diff = DiffImage(expected, actual);
  EXPECT_GT(Channel(diff, 1, 2, 0), 200);
  EXPECT_LT(Channel(diff, 1, 2, 1), 50);
  EXPECT_GE(Channel(diff, 0, 0, 0), 160);
  EXPECT_EQ(Channel(diff, 0, 0, 0), Channel(diff, 0, 0, 2));
}

TEST(Resample, AveragesBoxesAndRoundsToNearest) {
  const std::vector<std::uint8_t> large = {0, 0, 0, 255, 1, 0, 4, 255,   // first row, two pixels
                                           1, 0, 0, 255, 1, 1, 2, 255};  // second row
  Image target = GreyPicture(3, 2, 9);
  AverageInto(large.data(), 1, 1, 2, target, 2, 1);
  EXPECT_EQ(Channel(target, 2, 1, 0), 1);  // 3 / 4
  EXPECT_EQ(Channel(target, 2, 1, 1), 0);  // 1 / 4
  EXPECT_EQ(Channel(target, 2, 1, 2), 2);  // 6 / 4
  EXPECT_EQ(Channel(target, 2, 1, 3), 255);
  EXPECT_EQ(Channel(target, 1, 1, 0), 9) << "wrote outside its box";
}

}  // namespace
}  // namespace kinescope::render
