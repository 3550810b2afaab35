/// Interface for painting overlays as pixels (canvas.h) or as vectors (plot/layer.h), so that each
/// overlay is written once. Units: px of the picture, y downwards, a pixel's centre at (x + 0.5, y
/// + 0.5). Parts outside the current area are clipped. One thread.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/font.h"
#include "render/image/image.h"
#include "render/image/tile.h"

namespace kinescope::render {

struct Ink {
  Rgb color = {0, 0, 0};  // sRGB, 0..1
  double alpha = 1;
};

class Painter {
 public:
  virtual ~Painter() = default;

  /// What is painted from here on: "title", "legend", ...; for painters that keep texts.
  virtual void Begin(std::string_view /*part*/) {}

  /// Selects the area to paint: coordinates are then relative to the corner of `part`, and nothing
  /// is painted outside it. Initially the whole picture.
  virtual void Enter(const Tile& part) = 0;

  virtual void RoundedBox(double x, double y, double width, double height, double radius,
                          const Ink& ink) = 0;
  virtual void Disc(double x, double y, double radius, const Ink& ink) = 0;
  virtual void Ring(double x, double y, double inner_radius, double outer_radius,
                    const Ink& ink) = 0;
  /// Joined by straight lines with round corners and ends.
  virtual void Polyline(const std::vector<std::pair<double, double>>& points, double width,
                        const Ink& ink) = 0;
  /// Pixels as they are, opaque, their upper left corner at x, y; nothing unless painted as pixels
  /// or into a file.
  virtual void Picture(int /*x*/, int /*y*/, const Image& /*pixels*/) {}
  /// One line of text, starting at `x` on the baseline `y`. Returns the x where the next character
  /// would start.
  virtual double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
                      const Ink& ink) = 0;
};

}  // namespace kinescope::render
