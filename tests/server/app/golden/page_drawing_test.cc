// What is the same on two drawings of a page. Pages themselves are drawn in tests/system.
#include "server/app/golden/page_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinescope::app {
namespace {

PageDrawing DrawingOf(const std::string& rate, const std::string& clock = "") {
  PageDrawing drawing;
  render::SetSize(drawing.image, 100, 50);
  std::fill(drawing.image.rgba.begin(), drawing.image.rgba.end(), std::uint8_t{200});
  drawing.elements = {{"rate", "text", rate, 10, 10, 20, 5, false},
                      {"clock", "text", clock, 50.4, 10, 9.2, 5, true}};
  return drawing;
}

void Paint(int x, int y, PageDrawing& drawing) { drawing.image.rgba[4 * (100 * y + x) + 1] = 0; }

TEST(PageChange, IsNoneBetweenEqualDrawings) {
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), DrawingOf("60 Hz")), std::nullopt);
}

TEST(PageChange, NamesTheTextThatDiffersAsItWas) {
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), DrawingOf("61 Hz")), "'rate' (60 Hz)");
}

TEST(PageChange, NamesWhatIsGoneAndWhatIsNew) {
  PageDrawing more = DrawingOf("60 Hz");
  more.elements.push_back({"new", "text", "a", 0, 0, 5, 5, false});
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), more), "'new' (a)");
  EXPECT_EQ(FindChange(more, DrawingOf("60 Hz")), "'new' (a)");
}

TEST(PageChange, HasThePlaceOfPixelsThatDiffer) {
  PageDrawing other = DrawingOf("60 Hz");
  Paint(3, 40, other);
  Paint(12, 44, other);
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), other), "10x5 px at x 3, y 40");
}

TEST(PageChange, OfWhatChangesByItselfIsNone) {
  PageDrawing other = DrawingOf("60 Hz");
  other.elements[1].width_px = 12;
  Paint(50, 10, other);
  Paint(62, 14, other);
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), other), std::nullopt);
  Paint(63, 14, other);
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), other), "1x1 px at x 63, y 14") << "beside its box";
}

TEST(PageChange, OfTheSizeIsOne) {
  PageDrawing other = DrawingOf("60 Hz");
  render::SetSize(other.image, 50, 100);
  EXPECT_EQ(FindChange(DrawingOf("60 Hz"), other), "the size of the picture");
}

}  // namespace
}  // namespace kinescope::app
