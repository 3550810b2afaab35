/// What overlays are painted with: pixels (canvas.h) or vectors (plot/layer.h), so that each is
/// written once. Units: px of the picture, y downwards, a pixel's centre at (x + 0.5, y + 0.5).
/// Whatever lies outside the part being painted is cut off.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/font.h"
#include "render/tile.h"

namespace kinescope::render {

struct Ink {
  Rgb color = {0, 0, 0};  // sRGB, 0..1
  double alpha = 1;
};

class Painter {
 public:
  virtual ~Painter() = default;

  /// From now on coordinates count from the corner of `part`, and nothing is painted outside it.
  /// Begins with the whole picture.
  virtual void Enter(const Tile& part) = 0;

  virtual void RoundedBox(double x, double y, double width, double height, double radius,
                          const Ink& ink) = 0;
  virtual void Disc(double x, double y, double radius, const Ink& ink) = 0;
  virtual void Ring(double x, double y, double inner_radius, double outer_radius,
                    const Ink& ink) = 0;
  /// Joined by straight lines with round corners and ends.
  virtual void Polyline(const std::vector<std::pair<double, double>>& points, double width,
                        const Ink& ink) = 0;
  /// One line, starting at `x` on the baseline `y`. Returns where the next character would start.
  virtual double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
                      const Ink& ink) = 0;
};

}  // namespace kinescope::render
