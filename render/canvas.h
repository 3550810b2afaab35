/// Anti-aliased 2-D shapes and text on top of a finished picture. Units: px, y downwards, a pixel's
/// centre at (x + 0.5, y + 0.5). Whatever lies outside the picture is cut off.
#pragma once

#include <cstdint>
#include <string_view>

#include "render/font.h"
#include "render/image.h"
#include "server/core/palette.h"

namespace kinescope::render {

struct Ink {
  Rgb color = {0, 0, 0};  // sRGB, 0..1
  double alpha = 1;
};

class Canvas {
 public:
  explicit Canvas(Image& image) : image_(image) {}

  void RoundedBox(double x, double y, double width, double height, double radius, const Ink& ink);
  void Disc(double x, double y, double radius, const Ink& ink);
  void Ring(double x, double y, double inner_radius, double outer_radius, const Ink& ink);

  /// One line, starting at `x` on the baseline `y`. Returns where the next character would start.
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px, const Ink& ink);

 private:
  /// Blends `ink` with weight `coverage(x, y)` in 0..1 over the pixels of the box.
  template <class Coverage>
  void Fill(double left, double top, double right, double bottom, const Ink& ink,
            Coverage&& coverage);
  struct Paint;
  void Blend(int x, int y, const Paint& paint, double coverage);

  Image& image_;
};

}  // namespace kinescope::render
