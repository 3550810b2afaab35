#include "render/overlay.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/utf8.h"
#include "render/canvas.h"
#include "render/font.h"
#include "render/multi_view.h"
#include "render/overlay_scale.h"

namespace kinescope::render {
namespace {

TEST(Overlay, WritesTimesAsHoursMinutesAndSeconds) {
  EXPECT_EQ(TimeCode(0), "00:00:00.000");
  EXPECT_EQ(TimeCode(12'345), "00:00:12.345");
  EXPECT_EQ(TimeCode(3'600'000 + 2 * 60'000 + 3'004), "01:02:03.004");
  EXPECT_EQ(TimeCode(100LL * 3'600'000), "100:00:00.000");
  EXPECT_EQ(TimeCode(-1'500), "-00:00:01.500");
  EXPECT_FALSE(TimeCode(std::numeric_limits<std::int64_t>::min()).empty());
}

// The pixels that captions of marks paint, of a picture that has no other overlay.
int MarkedPixels(const std::vector<std::string>& marks, int width = 640, int height = 360) {
  PictureSpec spec;
  spec.width = width;
  spec.height = height;
  spec.parts = {};
  for (const OverlayInfo& info : kOverlays) spec.parts.*info.part = false;
  spec.parts.marks = true;
  spec.marks = marks;
  Image image{width, height,
              std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height), 100)};
  Canvas canvas(image);
  DrawnView view;
  view.tile = {0, 0, width, height};
  Overlay().Paint(canvas, SceneState(), {view}, spec);
  int changed = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] == 100 && image.rgba[i + 1] == 100 && image.rgba[i + 2] == 100) continue;
    ++changed;
    const auto x = static_cast<int>(i / 4) % width;
    EXPECT_LT(x, width / 2) << "in the left half";
  }
  return changed;
}

TEST(Overlay, ShowsMarksWhereThereIsRoom) {
  EXPECT_EQ(MarkedPixels({}), 0);
  const int one = MarkedPixels({"belt slipped"});
  EXPECT_GT(one, 500);
  EXPECT_GT(MarkedPixels({"belt slipped", "3  lift"}), one);
  EXPECT_EQ(MarkedPixels({"belt slipped"}, 200, 120), 0) << "too small for texts";
  const int four = MarkedPixels({"a", "a", "a", "a"});
  EXPECT_LT(MarkedPixels(std::vector<std::string>(5000, "a")), 3 * four) << "four lines at most";
  EXPECT_GT(MarkedPixels({std::string(100'000, 'x') + "\xFF"}), one) << "cut off";
}

TEST(Font, DecodesUtf8AndReplacesInvalidBytes) {
  EXPECT_EQ(DecodeUtf8("aé€😀"), U"aé€😀");
  EXPECT_EQ(DecodeUtf8("\xC0\xAF"), U"\uFFFD\uFFFD") << "overlong";
  EXPECT_EQ(DecodeUtf8("\xE2\x82"), U"\uFFFD") << "cut short";
  EXPECT_EQ(DecodeUtf8("\xED\xA0\x80"), U"\uFFFD") << "surrogate";
  EXPECT_EQ(DecodeUtf8("\xF5\x80\x80\x80"), U"\uFFFD\uFFFD\uFFFD\uFFFD") << "past the last plane";
  EXPECT_EQ(DecodeUtf8("a\nb"), U"a\uFFFDb") << "control character";
}

TEST(Font, MeasuresLongerTextAsWiderAndDigitsAsEqual) {
  Font font("DejaVuSans.ttf");
  EXPECT_GT(font.Width("MM", 16), font.Width("M", 16));
  EXPECT_NEAR(font.Width("00", 16), font.Width("19", 16), 1e-9) << "a clock must not jitter";
}

TEST(Font, NamesThePackageOfAMissingFont) {
  try {
    Font("NoSuchFont.ttf");
    FAIL() << "opened a font that does not exist";
  } catch (const RenderError& error) {
    EXPECT_NE(std::string(error.what()).find("fonts-dejavu-core"), std::string::npos);
  }
}

TEST(Canvas, ClipsShapesAtItsEdges) {
  Image image{8, 8, std::vector<std::uint8_t>(4 * 8 * 8, 255)};
  Canvas canvas(image);
  Font font("DejaVuSans.ttf");
  canvas.Disc(-3, 4, 5, {{0, 0, 0}, 1});
  canvas.RoundedBox(5, 5, 50, 50, 2, {{1, 0, 0}, 1});
  canvas.Text(-20, 6, "outside and inside", font, 12, {{0, 0, 1}, 1});
  canvas.Text(4, 300, "below", font, 12, {{0, 0, 1}, 1});
  EXPECT_EQ(image.rgba[4 * (4 * 8 + 0)], 0) << "inside the disc";
  EXPECT_EQ(image.rgba[4 * (7 * 8 + 7) + 1], 0) << "inside the box";
  EXPECT_EQ(image.rgba[4 * (4 * 8 + 0) + 3], 255) << "opaque as before";
}

TEST(Canvas, AntialiasesEdges) {
  Image image{4, 1, std::vector<std::uint8_t>(16, 255)};
  Canvas canvas(image);
  canvas.RoundedBox(0, -10, 1.5, 20, 0, {{0, 0, 0}, 1});
  EXPECT_EQ(image.rgba[0], 0);
  EXPECT_NEAR(image.rgba[4], 128, 1);
  EXPECT_EQ(image.rgba[8], 255);
}

TEST(Canvas, PaintsALineOnceWhereItsSegmentsMeet) {
  Image bent{20, 20, std::vector<std::uint8_t>(1600, 255)}, straight = bent;
  Canvas(bent).Polyline({{3, 10.2}, {7, 10.2}, {11, 10.2}, {17, 10.2}}, 3, {{0, 0, 0}, 0.5});
  Canvas(straight).Polyline({{3, 10.2}, {17, 10.2}}, 3, {{0, 0, 0}, 0.5});
  EXPECT_EQ(bent.rgba, straight.rgba);
  EXPECT_NEAR(bent.rgba[4 * (10 * 20 + 10)], 128, 1);
}

TEST(Canvas, PaintsOnlyInsideTheSelectedPart) {
  Image image{20, 20, std::vector<std::uint8_t>(1600, 255)};
  Canvas canvas(image);
  canvas.Enter({5, 6, 4, 3});
  canvas.Disc(2, 1, 30, {{0, 0, 0}, 1});
  canvas.Polyline({{-50, 1}, {50, 2}}, 9, {{0, 0, 0}, 1});
  int painted = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) painted += image.rgba[i] == 0;
  EXPECT_EQ(painted, 4 * 3);
}

TEST(ScaleBar, HasARoundLengthThatIsCorrectAtTheTarget) {
  Camera camera;
  camera.position = {7, 0, 1};
  camera.target = {0, 0, 1};
  for (const double height_m : {0.0, 0.05, 3.0, 70.0}) {  // 0: perspective
    camera.ortho_height_m = height_m;
    const ScaleBar bar = ScaleBarOf(camera, 1280, 720, 200);
    const double left = Project({0, 0, 1}, camera, 1280, 720).x_px;
    EXPECT_NEAR(Project({0, bar.length_m, 1}, camera, 1280, 720).x_px - left, bar.length_px, 1e-6);
    EXPECT_TRUE(bar.length_px <= 200 && bar.length_px > 200 / 2.6) << bar.text;
  }
  EXPECT_EQ(ScaleBarOf(camera, 1280, 720, 200).text, "10 m");
}

TEST(MultiView, DividesThePictureWithoutRemainder) {
  const auto tiles = PaneTiles(1001, 500, 5, 3);
  ASSERT_EQ(tiles.size(), 5u);
  EXPECT_EQ(tiles[2].x + tiles[2].width, 1001);
  EXPECT_EQ(tiles[4].x + tiles[4].width, 1001) << "two views share the last row";
  EXPECT_EQ(tiles[4].y + tiles[4].height, 500);
  EXPECT_EQ(tiles[1].x - (tiles[0].x + tiles[0].width), 1) << "a line between";
  EXPECT_THROW(PaneTiles(32, 500, 3, 3), UsageError);
}

}  // namespace
}  // namespace kinescope::render
