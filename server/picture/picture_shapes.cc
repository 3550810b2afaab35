#include "server/picture/picture_shapes.h"

#include <algorithm>
#include <utility>

#include "render/overlay_free_area.h"

namespace kinescope::app {

render::ViewShape PictureShapes::Of(const render::PictureSpec& spec, const SceneState& state) {
  constexpr std::size_t kMost = 8;  // that are remembered
  render::LegendContent legend = render::LegendOf(state, spec.look);
  const auto known = std::find_if(measured_.begin(), measured_.end(), [&](const Measured& each) {
    return each.width == spec.width && each.height == spec.height &&
           each.has_overlays == spec.overlays && each.legend.rows == legend.rows &&
           each.legend.notes == legend.notes && each.legend.images == legend.images;
  });
  if (known != measured_.end()) return known->shape;
  if (measured_.size() == kMost) measured_.erase(measured_.begin());
  render::ViewShape shape{static_cast<double>(spec.width) / spec.height, {}};
  try {
    shape.area = render::FreeAreasOf(spec, {{0, 0, spec.width, spec.height}}, 0, legend).front();
  } catch (const render::RenderError&) {
    return shape;  // a font is missing: the renderer reports it
  }
  measured_.push_back({spec.width, spec.height, spec.overlays, std::move(legend), shape});
  return shape;
}

}  // namespace kinescope::app
