/// Paints anti-aliased 2-D shapes and text on a finished picture. Units of Painter, px. One thread;
/// the picture must not be used elsewhere at the same time.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "render/image/image.h"
#include "render/painter.h"

namespace kinescope::render {

class Canvas : public Painter {
 public:
  explicit Canvas(Image& image) : image_(image), part_{0, 0, image.width, image.height} {}

  void Enter(const Tile& part) override { part_ = part; }
  void RoundedBox(double x, double y, double width, double height, double radius,
                  const Ink& ink) override;
  void Disc(double x, double y, double radius, const Ink& ink) override;
  void Ring(double x, double y, double inner_radius, double outer_radius, const Ink& ink) override;
  void Polyline(const std::vector<std::pair<double, double>>& points, double width,
                const Ink& ink) override;
  void Picture(int x, int y, const Image& pixels) override;
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink& ink) override;

 private:
  struct Columns {
    double first = 0, last = 0;  // px, from and to
  };
  /// Blends `ink` with weight `coverage(x, y)` in 0..1 over the pixels of the box. `whole`: the
  /// columns of a row that are known to be covered, which takes a tenth of the time.
  template <class Coverage>
  void Fill(double left, double top, double right, double bottom, const Ink& ink,
            Coverage&& coverage, const std::function<Columns(double y)>& whole = nullptr);
  struct Paint;
  /// Pixels of this part, which may be beyond its edges, are to be blended.
  void Mark(int x, int y, int width, int height);
  void Blend(int x, int y, const Paint& paint, double coverage);
  /// From `first_x` to `last_x`, both included.
  void BlendRow(int first_x, int last_x, int y, const Paint& paint, double coverage);

  Image& image_;
  Tile part_;  // within the image
};

}  // namespace kinescope::render
