#include "render/overlay_backdrop.h"

#include <cstddef>
#include <optional>

namespace kinescope::render {
namespace {

// Half way between dark and light texts, 0 to 1.
constexpr double kMiddleLightness = 0.54;

}  // namespace

double Lightness(const Rgb& color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

const Inks& InksOn(const Rgb& behind, const PictureSpec& spec) {
  if (spec.look.is_transparent || !spec.look.background) return InksOf(spec);
  return Lightness(behind) < kMiddleLightness ? kDarkInks : kLightInks;
}

const Inks& Backdrop::InksAt(double x, double y) const { return InksOn(ColorAt(x, y), spec_); }

const Inks& Backdrop::InksBesideScene() const { return InksOn(BackgroundOf(spec_.look), spec_); }

Rgb Backdrop::ColorAt(double x, double y) const {
  const Rgb& background = BackgroundOf(spec_.look);
  if (!spec_.look.floor) return background;
  for (const DrawnView& view : views_) {
    const Tile& tile = view.tile;
    const double in_x = x - tile.x, in_y = y - tile.y;
    if (in_x < 0 || in_y < 0 || in_x >= tile.width || in_y >= tile.height) continue;
    const auto point = FloorPointAt(in_x, in_y, view.camera, tile.width, tile.height);
    if (!point) return background;
    const double share = FloorShare((*point - view.camera.target.head<2>()).norm());
    const Rgb& floor = ColorsOf(spec_.look.theme).floor;
    Rgb color{};
    for (std::size_t i = 0; i < color.size(); ++i) {
      color[i] = background[i] + share * (floor[i] - background[i]);
    }
    return color;
  }
  return background;
}

}  // namespace kinescope::render
