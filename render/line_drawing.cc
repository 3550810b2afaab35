#include "render/line_drawing.h"

#include <algorithm>

#include "render/overlay_page.h"

namespace kinescope::render {
namespace {

struct Stroke {
  LineKind kind;
  double width;     // px in a picture 720 px high
  double print_pt;  // in print
  Ink Inks::*ink;
};
// From below.
constexpr Stroke kStrokes[] = {
    {LineKind::kBorder, 0.9, 0.4, &Inks::faint_text},
    {LineKind::kFace, 1.0, 0.5, &Inks::text},
    {LineKind::kCrease, 1.15, 0.55, &Inks::text},
    {LineKind::kOutline, 1.7, 0.8, &Inks::text},
};
constexpr double kThinnest = 0.7;  // px

double WidthOf(const Stroke& stroke, const PictureSpec& spec) {
  const double width = spec.print.is_known()
                           ? stroke.print_pt * spec.print.PixelsPerPoint(spec.width)
                           : stroke.width * spec.height / 720.0;
  return std::max(width, kThinnest);
}

}  // namespace

void PaintLines(Painter& painter, const std::vector<DrawnLine>& lines, const PictureSpec& spec) {
  const Inks& inks = InksOf(spec);
  for (const Stroke& stroke : kStrokes) {
    for (const DrawnLine& line : lines) {
      if (line.kind != stroke.kind) continue;
      painter.Polyline(line.points, WidthOf(stroke, spec), inks.*stroke.ink);
    }
  }
}

}  // namespace kinescope::render
