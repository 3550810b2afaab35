/// The lines of a picture in Style::kLine: plain data that a painter can draw as pixels or vectors.
#pragma once

#include <utility>
#include <vector>

#include "render/painter.h"
#include "render/renderer.h"

namespace kinescope::render {

enum class LineKind {
  kOutline,  // where a surface turns away from the viewer
  kCrease,   // where parts of the body press against each other
  kFace,     // brows, lids, nose, mouth
  kBorder,   // between the colours of the suit
};

struct DrawnLine {
  std::vector<std::pair<double, double>> points;  // px of the view, y downwards
  LineKind kind = LineKind::kOutline;
};

/// In the ink of the texts; outlines over creases and face over borders.
void PaintLines(Painter& painter, const std::vector<DrawnLine>& lines, const PictureSpec& spec);

}  // namespace kinescope::render
