#include "render/image/picture_difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/image/color_distance.h"
#include "render/image/heat_map.h"
#include "render/image/png_file.h"
#include "tests/folders.h"
#include "tests/render/image/picture_mutations.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

using kinescope::testing::Furnished;
using kinescope::testing::InSourceTree;
using kinescope::testing::MutationsOf;
using kinescope::testing::PictureMutation;
using kinescope::testing::Scaled;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Image Filled(int width, int height, const std::array<std::uint8_t, 4>& color) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    image.rgba.insert(image.rgba.end(), color.begin(), color.end());
  }
  return image;
}

void Fill(Image& image, const Tile& box, const std::array<std::uint8_t, 4>& color) {
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      std::copy(color.begin(), color.end(),
                image.rgba.begin() + 4 * (std::ptrdiff_t{y} * image.width + x));
    }
  }
}

std::vector<std::string> FailedLayers(const PictureDifference& difference) {
  std::vector<std::string> failed;
  for (const LayerVerdict& layer : JudgeLayers(difference)) {
    if (!layer.passes) failed.push_back(layer.layer);
  }
  return failed;
}

std::string TextOf(const PictureDifference& difference, const std::string& name) {
  for (const LayerVerdict& layer : JudgeLayers(difference)) {
    if (layer.layer == name) return layer.text;
  }
  return "";
}

Image Golden(const std::string& name) {
  return ReadPng(InSourceTree("golden_images/" + name + ".png").string());
}

class PictureDifferenceOf : public ::testing::TestWithParam<const char*> {};

TEST_P(PictureDifferenceOf, NamesTheLayerOfEachMutation) {
  const Image picture = Golden(GetParam());
  const Image expected = Furnished(picture);
  for (const PictureMutation& mutation : MutationsOf(picture)) {
    const auto failed = FailedLayers(FindDifference(expected, mutation.image));
    if (mutation.layer.empty()) {
      EXPECT_THAT(failed, IsEmpty()) << mutation.name;
    } else {
      EXPECT_THAT(failed, Contains(mutation.layer)) << mutation.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Renderings, PictureDifferenceOf,
                         ::testing::Values("lift_bend_right", "dark_compare", "walk_views"));

TEST(PictureDifference, OfSamePixelsInAnotherCompressionIsNone) {
  const kinescope::testing::TempFolder folder;
  const Image image = Golden("dark_compare");
  png_image other = {};
  other.version = PNG_IMAGE_VERSION;
  other.width = static_cast<png_uint_32>(image.width);
  other.height = static_cast<png_uint_32>(image.height);
  other.format = PNG_FORMAT_RGBA;  // all filters, level 6
  const std::string path = folder / "other.png";
  ASSERT_NE(png_image_write_to_file(&other, path.c_str(), 0, image.rgba.data(), 0, nullptr), 0);
  const PictureDifference difference = FindDifference(image, ReadPng(path));
  EXPECT_TRUE(difference.is_byte_equal);
  EXPECT_THAT(FailedLayers(difference), IsEmpty());
}

TEST(PictureDifference, SaysOnlyTheSizesWhereTheyDiffer) {
  const PictureDifference difference =
      FindDifference(Filled(8, 6, {9, 9, 9, 255}), Filled(6, 8, {9, 9, 9, 255}));
  EXPECT_THAT(FailedLayers(difference), ElementsAre("size"));
  EXPECT_EQ(TextOf(difference, "size"), "expected 8x6 px, found 6x8 px");
  const Image map = HeatMap(Filled(8, 6, {9, 9, 9, 255}), difference);
  EXPECT_EQ(map.width, 8);
  EXPECT_EQ(map.height, 8);
}

TEST(PictureDifference, MeasuresColorAsPixelmatchDoes) {
  const auto distance = [](float red, float green, float blue) {
    return DistanceOf(UnscaledSquaredDistance(red, green, blue));
  };
  EXPECT_NEAR(distance(-120, 61, 0), 0.290, 0.001) << "(200,80,80) and (80,141,80)";
  EXPECT_NEAR(distance(107, -51, -8), 0.259, 0.001) << "(0,158,115) and grey 107";
  EXPECT_NEAR(distance(13, 13, 13), 0.049, 0.001);
  EXPECT_NEAR(distance(255, 255, 255), 0.966, 0.001) << "black and white";
  double largest = 0;
  for (int corner = 0; corner < 27; ++corner) {
    const auto level = [&](int divisor) {
      return 255 * static_cast<float>(corner / divisor % 3 - 1);
    };
    largest = std::max(largest, distance(level(1), level(3), level(9)));
  }
  EXPECT_NEAR(largest, 1, 0.001);
}

TEST(PictureDifference, FindsTheLargestCluster) {
  const Image expected = Filled(100, 60, {240, 240, 240, 255});
  Image actual = expected;
  Fill(actual, {10, 12, 5, 4}, {0, 0, 0, 255});
  Fill(actual, {22, 14, 2, 2}, {0, 0, 0, 255});  // over a small gap
  Fill(actual, {80, 40, 4, 4}, {0, 0, 0, 255});
  const PictureDifference difference = FindDifference(expected, actual);
  ASSERT_EQ(difference.pixels.clusters.size(), 2U);
  EXPECT_EQ(difference.pixels.clusters[0].pixels, 24);
  EXPECT_EQ(difference.pixels.clusters[1].pixels, 16);
  EXPECT_THAT(TextOf(difference, "pixels"),
              AllOf(HasSubstr("40 beyond 0.05 of colour distance (0.67 %, limit 0)"),
                    HasSubstr("largest cluster 14x4 px at x 10, y 12 (24 pixels)")));
}

// Everything between what a pixel may differ by and what a picture may.
TEST(PictureDifference, DetectsATintThatNoPixelShows) {
  const Image expected = Filled(64, 64, {90, 120, 150, 255});
  const PictureDifference tinted = FindDifference(expected, Filled(64, 64, {93, 120, 147, 255}));
  EXPECT_THAT(FailedLayers(tinted), ElementsAre("light"));
  EXPECT_THAT(TextOf(tinted, "light"), HasSubstr("red +3.00, green +0.00, blue -3.00 levels"));
  const PictureDifference dark = FindDifference(expected, Scaled(expected, 0.98));
  EXPECT_THAT(FailedLayers(dark), ElementsAre("light"));
  EXPECT_THAT(TextOf(dark, "light"), HasSubstr("3.00 levels darker where luma is 64 to 127"));
}

TEST(PictureDifference, IgnoresLightOfFewPixels) {
  const Image expected = Filled(100, 100, {20, 20, 20, 255});
  Image few = expected, many = expected;
  Fill(few, {10, 10, 4, 4}, {26, 26, 26, 255});
  EXPECT_THAT(FailedLayers(FindDifference(expected, few)), IsEmpty());
  Fill(many, {10, 10, 50, 50}, {26, 26, 26, 255});
  EXPECT_THAT(FailedLayers(FindDifference(expected, many)), Contains("light"));
  const PictureDifference inverted =
      FindDifference(expected, Filled(100, 100, {250, 250, 250, 255}));
  EXPECT_THAT(TextOf(inverted, "light"), HasSubstr("not known"));
}

TEST(PictureDifference, SeesTransparencyOnWhiteAndOnBlack) {
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{255}}) {
    const Image expected = Filled(40, 40, {level, level, level, 0});
    Image actual = expected;
    Fill(actual, {4, 4, 20, 20}, {level, level, level, 255});
    EXPECT_THAT(FailedLayers(FindDifference(expected, actual)), Contains("pixels")) << int{level};
  }
  const PictureDifference hidden =
      FindDifference(Filled(40, 40, {0, 90, 200, 0}), Filled(40, 40, {10, 20, 30, 0}));
  EXPECT_FALSE(hidden.is_byte_equal);
  EXPECT_THAT(FailedLayers(hidden), IsEmpty());
}

// As the definition says, window by window.
double SimilarityOfWindow(const LumaPlane& a, const LumaPlane& b, int left, int top) {
  double mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, covariance = 0;
  const auto each = [&](const auto& use) {
    for (int y = top; y < top + 8; ++y) {
      for (int x = left; x < left + 8; ++x) use(a.Row(y)[x], b.Row(y)[x]);
    }
  };
  each([&](double p, double q) { mean_a += p / 64, mean_b += q / 64; });
  each([&](double p, double q) {
    var_a += (p - mean_a) * (p - mean_a) / 64;
    var_b += (q - mean_b) * (q - mean_b) / 64;
    covariance += (p - mean_a) * (q - mean_b) / 64;
  });
  const double c1 = std::pow(0.01 * 255, 2), c2 = std::pow(0.03 * 255, 2);
  return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
         ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
}

TEST(Structure, IsThatOfTheDefinition) {
  std::mt19937 random(5);
  for (const auto& [width, height] : {std::pair{70, 45}, {64, 32}, {5, 3}, {36, 41}}) {
    Image one = Filled(width, height, {0, 0, 0, 255}), other = one;
    for (std::uint8_t& channel : one.rgba) channel = static_cast<std::uint8_t>(random());
    for (std::uint8_t& channel : other.rgba) channel = static_cast<std::uint8_t>(random());
    const LumaPlane a(one), b(other);
    double sum = 0, worst = 1;
    int count = 0;
    std::map<std::pair<int, int>, std::vector<double>> blocks;
    for (int y = 0; y + 8 <= 4 * a.rows(); y += 4) {
      for (int x = 0; x + 8 <= 4 * a.columns(); x += 4) {
        const double similarity = SimilarityOfWindow(a, b, x, y);
        sum += similarity;
        ++count;
        blocks[{y / 32, x / 32}].push_back(similarity);
      }
    }
    for (const auto& [place, windows] : blocks) {
      double of_block = 0;
      for (const double window : windows) of_block += window;
      worst = std::min(worst, of_block / static_cast<double>(windows.size()));
    }
    const std::size_t all =
        static_cast<std::size_t>(BlocksIn(width)) * static_cast<std::size_t>(BlocksIn(height));
    const Structure structure = CompareStructure(a, b, std::vector<std::uint8_t>(all, 1));
    EXPECT_THAT(structure.mean, DoubleNear(sum / count, 1e-5)) << width << "x" << height;
    EXPECT_THAT(structure.worst, DoubleNear(worst, 1e-5)) << width << "x" << height;
  }
}

TEST(Structure, NamesTheBlockOfTheOnlyChange) {
  const Image expected = Filled(100, 70, {240, 240, 240, 255});
  Image actual = expected;
  Fill(actual, {66, 34, 8, 8}, {0, 0, 0, 255});
  const Structure structure = FindDifference(expected, actual).structure;
  EXPECT_EQ(structure.worst_block.x, 64);
  EXPECT_EQ(structure.worst_block.y, 32);
  EXPECT_EQ(structure.worst_block.width, 32);
  EXPECT_LT(structure.mean, 1);
}

TEST(HeatMap, ShowsDistancesInColorsOnAPalePicture) {
  const Image expected = Filled(32, 32, {128, 128, 128, 255});
  Image actual = expected;
  Fill(actual, {0, 0, 8, 8}, {146, 146, 146, 255});
  Fill(actual, {16, 16, 8, 8}, {255, 255, 255, 255});
  const Image map = HeatMap(expected, FindDifference(expected, actual));
  const auto color = [&](int x, int y) {
    const std::size_t at = 4 * static_cast<std::size_t>(y * 32 + x);
    return std::vector<int>(map.rgba.begin() + static_cast<std::ptrdiff_t>(at),
                            map.rgba.begin() + static_cast<std::ptrdiff_t>(at) + 4);
  };
  EXPECT_THAT(color(3, 3), ElementsAre(250, 195, 40, 255));
  EXPECT_THAT(color(20, 20), ElementsAre(95, 0, 70, 255));
  EXPECT_THAT(color(30, 3), ElementsAre(207, 207, 207, 255));
}

}  // namespace
}  // namespace kinescope::render
