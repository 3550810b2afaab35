#include "render/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kinescope::render {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pointwise;

TEST(Plot, HasTicksAtRoundNumbers) {
  EXPECT_THAT(NiceTicks(0, 1, 5), ElementsAre(0, 0.2, 0.4, DoubleNear(0.6, 1e-12), 0.8, 1));
  EXPECT_THAT(NiceTicks(-7, 12, 4), ElementsAre(-5, 0, 5, 10));
  EXPECT_THAT(NiceTicks(0, 8, 8), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
  for (double size = 1e-6; size < 1e9; size *= 3.7) {
    const auto ticks = NiceTicks(0.3 * size, 1.3 * size, 6);
    EXPECT_GE(ticks.size(), 2U) << size;
    EXPECT_LE(ticks.size(), 8U) << size;
  }
}

TEST(Plot, KeepsPeaksAndGapsOfAThinnedCurve) {
  std::vector<std::pair<double, double>> points;
  for (int i = 0; i < 100000; ++i) points.emplace_back(i, std::sin(0.01 * i));
  points[31415].second = 7;
  points[50000].second = std::numeric_limits<double>::quiet_NaN();
  const auto thin = Thinned(points, 0, 100000, 300);
  EXPECT_LE(thin.size(), 4 * 302U);
  double highest = 0;
  int breaks = 0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (std::isnan(thin[i].second)) ++breaks;
    if (thin[i].second > highest) highest = thin[i].second;
    if (i > 0) {
      EXPECT_GE(thin[i].first, thin[i - 1].first);
    }
  }
  EXPECT_EQ(highest, 7);
  EXPECT_EQ(breaks, 1);
}

Plot OnePanel() {
  Plot plot;
  plot.width = 100;
  plot.height = 80;
  PlotPanel panel;
  panel.left = 20;
  panel.top = 10;
  panel.width = 70;
  panel.height = 40;
  panel.bands = {{0, 0.5, {1, 0, 0}, ""}, {0.5, 1e9, {0, 0, 1}, ""}};
  panel.class_timeline = {{0, 0.5, LoadClass::kHigh}, {0.5, 1, LoadClass::kLow}};
  plot.panels.push_back(panel);
  return plot;
}

std::vector<double> PixelAt(const Image& image, double x_pt, double y_pt, double scale) {
  const auto at =
      4 * (static_cast<std::size_t>(y_pt * scale) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x_pt * scale));
  return {1.0 * image.rgba[at], 1.0 * image.rgba[at + 1], 1.0 * image.rgba[at + 2]};
}

TEST(Plot, ShowsBandsAndClassesAtTheirPlaces) {
  const Image image = ToImage(OnePanel(), 4);
  EXPECT_EQ(image.width, 400);
  EXPECT_EQ(image.height, 320);
  EXPECT_THAT(PixelAt(image, 50, 20, 4), ElementsAre(0, 0, 255));    // y 0.75
  EXPECT_THAT(PixelAt(image, 50, 40, 4), ElementsAre(255, 0, 0));    // y 0.25
  EXPECT_THAT(PixelAt(image, 2, 2, 4), ElementsAre(255, 255, 255));  // outside
  // The class timeline: high fills it, low a third of it.
  const Rgb high = ColorOf(LoadClass::kHigh), low = ColorOf(LoadClass::kLow);
  const auto levels = [](const Rgb& color) {
    std::vector<double> all;
    for (const double channel : color) all.push_back(255 * channel);
    return all;
  };
  const double top_of_timeline = 10 + 40 + 3.5, foot_of_timeline = 10 + 40 + 10;
  EXPECT_THAT(PixelAt(image, 30, top_of_timeline, 4), Pointwise(DoubleNear(1), levels(high)));
  EXPECT_THAT(PixelAt(image, 80, top_of_timeline, 4), ElementsAre(255, 255, 255));
  EXPECT_THAT(PixelAt(image, 80, foot_of_timeline, 4), Pointwise(DoubleNear(1), levels(low)));
}

TEST(Plot, IsReproducibleInBothFormats) {
  EXPECT_EQ(ToSvg(OnePanel()), ToSvg(OnePanel()));
  EXPECT_EQ(ToImage(OnePanel(), 2).rgba, ToImage(OnePanel(), 2).rgba);
}

TEST(Plot, AcceptsInvalidUtf8AndHugeValues) {
  Plot plot = OnePanel();
  plot.texts.push_back({5, 70, "\xFF\xC0 name", 8, false, {}});
  PlotCurve curve;
  curve.points = {{0, 0}, {0.5, 1e300}, {1, -1e300}};
  plot.panels[0].curves.push_back(curve);
  EXPECT_THAT(ToSvg(plot), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace kinescope::render
