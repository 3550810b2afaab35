#include "render/overlay_free_area.h"

#include <algorithm>

#include "render/overlay_images.h"
#include "render/overlay_legend.h"
#include "render/overlay_page.h"
#include "render/overlay_plot.h"

namespace kinescope::render {
namespace {

// px of the scene, whose corner is that of the picture.
struct Covered {
  double left, top, right, bottom;
};

std::vector<Covered> CoveredBy(const PictureSpec& spec, std::size_t curves,
                               const LegendContent& legend) {
  std::vector<Covered> covered;
  if (!spec.overlays) return covered;
  OverlayFonts fonts;
  const OverlaySizes sizes = SizesOfScene(spec, fonts);
  const double margin = sizes.Px(kMargin);
  if (sizes.bottom < sizes.height) covered.push_back({0, sizes.bottom, sizes.width, sizes.height});
  if (sizes.is_small) return covered;
  if (spec.parts.status || (spec.parts.title && !spec.title.empty())) {
    covered.push_back({0, 0, sizes.width, margin + 1.3 * sizes.FontPx(kTitleSize)});
  }
  if (spec.parts.legend && !spec.scene) {
    const LegendRoom room = RoomOfLegend(sizes, spec.look, legend);
    if (room.height > 0) {
      covered.push_back({0, sizes.bottom - room.height, room.width, sizes.height});
    }
  }
  if (spec.parts.time) {
    const double width = fonts.regular.Width("00:00:00.000", sizes.FontPx(kTitleSize));
    const double height = sizes.Px(kTimeCodeLine) + 1.3 * sizes.FontPx(kTitleSize);
    covered.push_back({sizes.right() - width - margin, sizes.bottom - margin - height, sizes.width,
                       sizes.height});
  }
  if (spec.parts.images) {
    for (const ImagePlace& place :
         PlacesOfImages(sizes, legend.images, spec.parts.plot && curves > 0)) {
      covered.push_back({place.left - margin, place.top - margin, sizes.width, sizes.height});
    }
  }
  if (spec.parts.plot && curves > 0) {
    const PlotRoom room = RoomOfPlot(sizes, curves);
    covered.push_back(
        {sizes.right() - room.width - margin, 0, sizes.width, room.top + room.height + margin});
  }
  return covered;
}

// `covered` cut out of what is free: from side to side, or as a corner.
void CutOut(const PictureRect& covered, FreeArea& area) {
  const bool is_across = covered.left <= 0 && covered.right >= 1;
  if (!is_across) {
    area.corners.push_back(covered);
  } else if (covered.top <= 0) {
    area.free.top = std::max(area.free.top, covered.bottom);
  } else {
    area.free.bottom = std::min(area.free.bottom, covered.top);
  }
}

}  // namespace

std::vector<FreeArea> FreeAreasOf(const PictureSpec& spec, const std::vector<Tile>& views,
                                  std::size_t curves, const LegendContent& legend) {
  const std::vector<Covered> all = CoveredBy(spec, curves, legend);
  std::vector<FreeArea> areas;
  for (const Tile& view : views) {
    FreeArea& area = areas.emplace_back();
    for (const Covered& each : all) {
      const PictureRect covered = {std::max(0.0, (each.left - view.x) / view.width),
                                   std::max(0.0, (each.top - view.y) / view.height),
                                   std::min(1.0, (each.right - view.x) / view.width),
                                   std::min(1.0, (each.bottom - view.y) / view.height)};
      const bool is_there = covered.left < covered.right && covered.top < covered.bottom;
      if (is_there) CutOut(covered, area);
    }
    // The name of a view is at its upper edge, or below the overlays at that edge.
    if (views.size() > 1 && spec.overlays) {
      OverlayFonts fonts;
      area.free.top += 2.2 * SizesOf(spec, fonts).FontPx(kSmallSize) / view.height;
    }
    // No room is no reason to draw nothing.
    if (area.free.bottom - area.free.top < 0.3) area = FreeArea();
  }
  return areas;
}

}  // namespace kinescope::render
