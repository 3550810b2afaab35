#include "render/overlay.h"

#include <gtest/gtest.h>

#include <limits>

#include "render/canvas.h"
#include "render/font.h"

namespace kinescope::render {
namespace {

TEST(Overlay, WritesTimesAsPeopleReadThem) {
  EXPECT_EQ(TimeCode(0), "00:00:00.000");
  EXPECT_EQ(TimeCode(12'345), "00:00:12.345");
  EXPECT_EQ(TimeCode(3'600'000 + 2 * 60'000 + 3'004), "01:02:03.004");
  EXPECT_EQ(TimeCode(100LL * 3'600'000), "100:00:00.000");
  EXPECT_EQ(TimeCode(-1'500), "-00:00:01.500");
  EXPECT_FALSE(TimeCode(std::numeric_limits<std::int64_t>::min()).empty());
}

TEST(Font, DecodesWhatIsUtf8AndMarksWhatIsNot) {
  EXPECT_EQ(DecodeUtf8("aé€😀"), U"aé€😀");
  EXPECT_EQ(DecodeUtf8("\xC0\xAF"), U"\uFFFD\uFFFD") << "overlong";
  EXPECT_EQ(DecodeUtf8("\xE2\x82"), U"\uFFFD") << "cut short";
  EXPECT_EQ(DecodeUtf8("\xED\xA0\x80"), U"\uFFFD") << "surrogate";
  EXPECT_EQ(DecodeUtf8("\xF5\x80\x80\x80"), U"\uFFFD\uFFFD\uFFFD\uFFFD") << "past the last plane";
  EXPECT_EQ(DecodeUtf8("a\nb"), U"a\uFFFDb") << "control character";
}

TEST(Font, LongerTextIsWider) {
  Font font("DejaVuSans.ttf");
  EXPECT_GT(font.Width("MM", 16), font.Width("M", 16));
  EXPECT_NEAR(font.Width("00", 16), font.Width("19", 16), 1e-9) << "a clock must not jitter";
}

TEST(Font, AMissingFontNamesThePackage) {
  try {
    Font("NoSuchFont.ttf");
    FAIL() << "opened a font that does not exist";
  } catch (const RenderError& error) {
    EXPECT_NE(std::string(error.what()).find("fonts-dejavu-core"), std::string::npos);
  }
}

TEST(Canvas, CutsOffWhatLiesOutside) {
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

TEST(Canvas, EdgesAreHalfCovered) {
  Image image{4, 1, std::vector<std::uint8_t>(16, 255)};
  Canvas canvas(image);
  canvas.RoundedBox(0, -10, 1.5, 20, 0, {{0, 0, 0}, 1});
  EXPECT_EQ(image.rgba[0], 0);
  EXPECT_NEAR(image.rgba[4], 128, 1);
  EXPECT_EQ(image.rgba[8], 255);
}

}  // namespace
}  // namespace kinescope::render
