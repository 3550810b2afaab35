// The plot strip, read back from the pixels that it is painted into.
#include "render/overlay_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/canvas.h"
#include "render/overlay.h"

namespace kinescope::render {
namespace {

constexpr int kPlotPictureWidth = 2560, kPlotPictureHeight = 1440;
constexpr int kPlotColumn = 2276;  // within the plot, right of the cursor and of the curve

struct PlotBand {
  LoadClass load_class;
  int height_px;
};

// What a band of that class looks like on the light theme's white panel.
std::array<int, 3> BandColor(LoadClass load_class) {
  std::array<int, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double alpha = kLightInks.band_alpha;
    color[i] = static_cast<int>(std::lround(255 * (1 - alpha + alpha * ColorOf(load_class)[i])));
  }
  return color;
}

// From top to bottom.
std::vector<PlotBand> BandsIn(const Image& image) {
  std::vector<PlotBand> bands;
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* pixel =
        &image.rgba[4 * static_cast<std::size_t>(y * image.width + kPlotColumn)];
    for (const LoadClass load_class : {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
      const std::array<int, 3> color = BandColor(load_class);
      if (!std::equal(color.begin(), color.end(), pixel,
                      [](int a, int b) { return std::abs(a - b) <= 2; })) {
        continue;
      }
      if (bands.empty() || bands.back().load_class != load_class) bands.push_back({load_class, 0});
      ++bands.back().height_px;
    }
  }
  return bands;
}

// A plot of one joint whose ratio was `ratio` at the clip's beginning.
Image PlotWith(const std::array<double, 2>& class_limits, double ratio) {
  LoadCurves loads;
  loads.curves = {{"Right elbow", {{0, ratio, LoadClass::kLow}, {0.1, ratio, LoadClass::kLow}}}};
  PictureSpec spec;
  spec.width = kPlotPictureWidth;
  spec.height = kPlotPictureHeight;
  spec.parts = {false, false, false, false, false, false, false, false, true};
  spec.load_curves = std::make_shared<const LoadCurves>(loads);
  SceneState state;
  state.liveness = Liveness::kLive;
  state.class_limits = class_limits;
  Image image;
  SetSize(image, spec.width, spec.height);
  std::fill(image.rgba.begin(), image.rgba.end(), 255);
  Canvas canvas(image);
  Overlay().Paint(canvas, state, {}, spec);
  return image;
}

TEST(OverlayPlot, HasBandsAtTheClassLimitsOfTheScene) {
  struct Case {
    std::array<double, 2> limits;
    double ratio, top;
  };
  for (const Case& each : {Case{{0.3, 0.6}, 0.2, 1},    // as it always was
                           Case{{0.3, 0.6}, 1.4, 1.5},  // more than all of capacity was needed
                           Case{{0.3, 0.6}, 9, 3},      // no further than that
                           Case{{0.1, 0.2}, 0.2, 1}, Case{{0.06, 0.9}, 0.2, 1},
                           Case{{0.5, 1}, 0.2, 1.5},  // some of the high class is always seen
                           Case{{2, 4}, 0.2, 4.5}, Case{{2, 4}, 9, 4.5}}) {
    SCOPED_TRACE(::testing::Message()
                 << each.limits[0] << ", " << each.limits[1] << ", ratio " << each.ratio);
    const std::vector<PlotBand> bands = BandsIn(PlotWith(each.limits, each.ratio));
    ASSERT_EQ(bands.size(), 3u);
    EXPECT_EQ(bands[0].load_class, LoadClass::kHigh);
    EXPECT_EQ(bands[1].load_class, LoadClass::kMedium);
    EXPECT_EQ(bands[2].load_class, LoadClass::kLow);
    const double height = bands[0].height_px + bands[1].height_px + bands[2].height_px;
    EXPECT_GT(height, 80);
    EXPECT_NEAR(bands[0].height_px, height * (1 - each.limits[1] / each.top), 1);
    EXPECT_NEAR(bands[2].height_px, height * each.limits[0] / each.top, 1);
  }
}

}  // namespace
}  // namespace kinescope::render
