// Texts without a panel of their own stand out from what is behind them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "render/legend_place.h"
#include "render/overlay.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::Posture;
using kinescope::testing::SceneWith;
using ::testing::Contains;
using ::testing::Key;

// The lightness of each text that is not on a box, 0 to 1.
class InkRecorder : public Painter {
 public:
  void Enter(const Tile& part) override { tile_ = part; }
  void RoundedBox(double x, double y, double width, double height, double /*radius*/,
                  const Ink& /*ink*/) override {
    boxes_.push_back({tile_.x + x, tile_.y + y, tile_.x + x + width, tile_.y + y + height});
  }
  void Disc(double /*x*/, double /*y*/, double /*radius*/, const Ink& /*ink*/) override {}
  void Ring(double /*x*/, double /*y*/, double /*inner_radius*/, double /*outer_radius*/,
            const Ink& /*ink*/) override {}
  void Polyline(const std::vector<std::pair<double, double>>& /*points*/, double /*width*/,
                const Ink& /*ink*/) override {}
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink& ink) override {
    const double left = tile_.x + x, baseline = tile_.y + y;
    bool is_on_box = false;
    for (const Box& box : boxes_) {
      is_on_box = is_on_box || (left >= box.left && left < box.right && baseline > box.top &&
                                baseline < box.bottom);
    }
    if (!is_on_box) lightness[std::string(utf8)] = ink.color[1];
    return x + font.Width(utf8, size_px);
  }

  std::map<std::string, double> lightness;

 private:
  struct Box {
    double left, top, right, bottom;
  };
  std::vector<Box> boxes_;
  Tile tile_{};
};

constexpr Rgb kBlack = {0, 0, 0}, kWhite = {1, 1, 1};

struct Look {
  Theme theme;
  Rgb background;
  bool floor;
};

std::map<std::string, double> TextsOn(const Look& with, LegendPlace place,
                                      const std::string& camera = "front") {
  const SceneState state = SceneWith(Posture::kStanding);
  PictureSpec spec;
  spec.width = 1280;
  spec.height = 720;
  spec.title = "a title";
  spec.legend = place;
  spec.parts.scale = true;
  spec.look.theme = with.theme;
  spec.look.background = with.background;
  spec.look.floor = with.floor;
  PlaceLegend(spec, LegendOf(state, spec.look));
  InkRecorder recorder;
  Overlay().Paint(recorder, state, {{spec.SceneTile(), NamedCamera(camera, state), "", {}}}, spec);
  EXPECT_THAT(recorder.lightness, Contains(Key("a title")));
  EXPECT_THAT(recorder.lightness, Contains(Key("00:00:12.345")));
  return recorder.lightness;
}

TEST(OverlayContrast, TextsBesideTheSceneAreReadableOnAnyBackground) {
  for (const LegendPlace place : {LegendPlace::kBelow, LegendPlace::kOutside}) {
    for (const Theme theme : {Theme::kLight, Theme::kDark}) {
      for (const Rgb& background : {kBlack, kWhite}) {
        const auto texts = TextsOn({theme, background, false}, place);
        EXPECT_THAT(texts, Contains(Key("low")));
        EXPECT_THAT(texts, Contains(Key("total, static")));
        for (const auto& [text, lightness] : texts) {
          EXPECT_GT(std::abs(lightness - background[1]), 0.5) << text << " on " << background[1];
        }
      }
    }
  }
}

TEST(OverlayContrast, TextsOverTheFloorDifferFromTheFloorAndOthersFromTheBackground) {
  const auto black = TextsOn({Theme::kLight, kBlack, true}, LegendPlace::kOutside);
  EXPECT_GT(black.at("a title"), 0.5) << "over the background";
  EXPECT_GT(black.at("low"), 0.5) << "beside the scene";
  EXPECT_LT(black.at("00:00:12.345"), 0.5) << "over the light floor";
  const auto white = TextsOn({Theme::kDark, kWhite, true}, LegendPlace::kOutside);
  EXPECT_LT(white.at("a title"), 0.5);
  EXPECT_LT(white.at("low"), 0.5);
  EXPECT_GT(white.at("00:00:12.345"), 0.5);
}

TEST(OverlayContrast, ATitleOverTheFloorIsReadable) {
  const auto texts = TextsOn({Theme::kLight, kBlack, true}, LegendPlace::kBelow, "top");
  EXPECT_LT(texts.at("a title"), 0.5) << "the camera sees nothing but the floor";
  EXPECT_GT(texts.at("low"), 0.5);
}

}  // namespace
}  // namespace kinescope::render
