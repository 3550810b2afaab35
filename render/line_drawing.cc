#include "render/line_drawing.h"

#include <algorithm>

#include "render/overlay_page.h"

namespace kinescope::render {
namespace {

// px in a picture 720 px high; pt in print.
constexpr double kOutlineWidth = 1.7, kBorderWidth = 0.9;
constexpr double kOutlinePt = 0.8, kBorderPt = 0.4;
constexpr double kThinnest = 0.7;  // px

double WidthOf(LineKind kind, const PictureSpec& spec) {
  const bool is_outline = kind == LineKind::kOutline;
  const double width =
      spec.print.is_known()
          ? (is_outline ? kOutlinePt : kBorderPt) * spec.print.PixelsPerPoint(spec.width)
          : (is_outline ? kOutlineWidth : kBorderWidth) * spec.height / 720.0;
  return std::max(width, kThinnest);
}

}  // namespace

void PaintLines(Painter& painter, const std::vector<DrawnLine>& lines, const PictureSpec& spec) {
  const Inks& inks = InksOf(spec);
  for (const LineKind kind : {LineKind::kBorder, LineKind::kOutline}) {
    const Ink& ink = kind == LineKind::kOutline ? inks.text : inks.faint_text;
    for (const DrawnLine& line : lines) {
      if (line.kind == kind) painter.Polyline(line.points, WidthOf(kind, spec), ink);
    }
  }
}

}  // namespace kinescope::render
