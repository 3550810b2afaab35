#include "server/app/render/picture_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/app/render/output_plan.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::TempFolder;
using ::testing::HasSubstr;

// A sequence of 2 x 1 pixels, whose left one is black and whose right one has these levels.
std::string WriteLevels(const std::string& pattern, const std::vector<int>& levels) {
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const auto level = static_cast<std::uint8_t>(levels[k]);
    render::WritePng(PathOfPicture(pattern, static_cast<long>(k)),
                     render::Image{2, 1, {0, 0, 0, 255, level, level, level, 255}}, {});
  }
  return pattern;
}

TEST(PictureComparison, FindsTheFirstPictureThatDiffers) {
  const TempFolder folder;
  const std::string then = WriteLevels(folder / "a%d.png", {10, 20, 30, 40});
  const std::string now = WriteLevels(folder / "b%d.png", {10, 20, 31, 99});
  const Verdict exact = ComparePictures(then, now, {0, 0}, std::nullopt);
  EXPECT_FALSE(exact.same);
  EXPECT_EQ(exact.picture, 2);
  EXPECT_THAT(exact.how, HasSubstr("1 pixel"));
  EXPECT_EQ(exact.diff.width, 2);
  EXPECT_EQ(ComparePictures(then, now, {1, 0}, std::nullopt).picture, 3) << "one level is rounding";
  EXPECT_TRUE(ComparePictures(then, now, {1, 0.5}, std::nullopt).same) << "half may differ";
  EXPECT_TRUE(ComparePictures(then, now, {0, 0}, 2).same) << "the first two";
}

TEST(PictureComparison, ReportsADifferentNumberOfFrames) {
  const TempFolder folder;
  const std::string longer = WriteLevels(folder / "a%d.png", {10, 20, 30});
  const std::string shorter = WriteLevels(folder / "b%d.png", {10, 20});
  EXPECT_EQ(ComparePictures(longer, shorter, {0, 0}, std::nullopt).how,
            "it has more than 2 pictures");
  EXPECT_EQ(ComparePictures(shorter, longer, {0, 0}, std::nullopt).how, "it has only 2 pictures");
  EXPECT_TRUE(ComparePictures(longer, shorter, {0, 0}, 2).same);
}

}  // namespace
}  // namespace kinescope::app
