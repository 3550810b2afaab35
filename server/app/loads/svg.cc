#include "server/app/loads/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/suit_colors.h"
#include "server/app/html.h"

namespace kinescope::app {
namespace {

std::string SvgNumber(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string SvgStrokeAttributes(const SvgStroke& stroke) {
  std::string text = fmt::format(R"(fill="none" stroke="{}" stroke-width="{}")",
                                 ToHex(stroke.color), SvgNumber(stroke.width));
  if (!stroke.dash.empty()) text += fmt::format(R"( stroke-dasharray="{}")", stroke.dash);
  return text;
}

std::string SvgBoxAttributes(const SvgBox& box) {
  return fmt::format(R"(x="{}" y="{}" width="{}" height="{}")", SvgNumber(box.left),
                     SvgNumber(box.top), SvgNumber(box.width), SvgNumber(box.height));
}

}  // namespace

SvgDrawing::SvgDrawing(double width_mm, double height_mm, std::string_view description) {
  svg_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 "
      "{0} "
      "{1}\" role=\"img\" aria-label=\"{2}\" font-family=\"Arial, 'Liberation Sans', Helvetica, "
      "sans-serif\" font-size=\"{3}\">",
      SvgNumber(width_mm), SvgNumber(height_mm), EscapeHtml(description), kSvgTextMm);
}

void SvgDrawing::Fill(const SvgBox& box, const Rgb& color) {
  svg_ += fmt::format("<rect {} fill=\"{}\"/>", SvgBoxAttributes(box), ToHex(color));
}

void SvgDrawing::Outline(const SvgBox& box, const SvgStroke& stroke) {
  svg_ += fmt::format("<rect {} {}/>", SvgBoxAttributes(box), SvgStrokeAttributes(stroke));
}

void SvgDrawing::Hatch(const SvgBox& box, double pitch, bool rises, const SvgStroke& stroke) {
  // Along x + y = sum where y grows downwards: rising lines. Mirrored: falling ones. Sums are
  // multiples of the pitch, so that neighbouring boxes have one hatching.
  const double right = box.left + box.width;
  std::string path;
  const auto mirrored = [&](double x) { return rises ? x : box.left + right - x; };
  const double first = std::ceil((box.left + box.top) / pitch),
               last = (right + box.top + box.height) / pitch;
  for (int i = 0; first + i < last; ++i) {
    const double sum = (first + i) * pitch;
    const double x0 = std::max(box.left, sum - box.top - box.height);
    const double x1 = std::min(right, sum - box.top);
    if (x1 <= x0) continue;
    path += fmt::format("M{} {}L{} {}", SvgNumber(mirrored(x0)), SvgNumber(sum - x0),
                        SvgNumber(mirrored(x1)), SvgNumber(sum - x1));
  }
  if (path.empty()) return;
  svg_ += fmt::format("<path d=\"{}\" {}/>", path, SvgStrokeAttributes(stroke));
}

void SvgDrawing::Line(const Points& points, const SvgStroke& stroke) {
  std::string path;
  bool is_down = false;
  for (const auto& [x, y] : points) {
    if (!std::isfinite(y)) {
      is_down = false;
      continue;
    }
    path += fmt::format("{}{} {}", is_down ? 'L' : 'M', SvgNumber(x), SvgNumber(y));
    is_down = true;
  }
  if (path.empty()) return;
  svg_ += fmt::format("<path d=\"{}\" {} stroke-linejoin=\"round\"/>", path,
                      SvgStrokeAttributes(stroke));
}

void SvgDrawing::Area(const Points& points, const Rgb& color) {
  std::string path;
  for (const auto& [x, y] : points) {
    path += fmt::format("{}{} {}", path.empty() ? 'M' : 'L', SvgNumber(x), SvgNumber(y));
  }
  if (path.empty()) return;
  svg_ += fmt::format("<path d=\"{}Z\" fill=\"{}\"/>", path, ToHex(color));
}

void SvgDrawing::Dot(double x, double y, double radius, bool is_filled) {
  svg_ += fmt::format(
      "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"0.2\"/>",
      SvgNumber(x), SvgNumber(y), SvgNumber(radius),
      ToHex(is_filled ? SvgStroke().color : Rgb{1, 1, 1}), ToHex(SvgStroke().color));
}

void SvgDrawing::Text(double x, double y, std::string_view text, const SvgText& look) {
  const char* const anchors[] = {"start", "middle", "end"};
  svg_ += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\" text-anchor=\"{}\"{}>{}</text>",
                      SvgNumber(x), SvgNumber(y), ToHex(look.color),
                      anchors[static_cast<std::size_t>(look.anchor)],
                      look.is_bold ? " font-weight=\"bold\"" : "", EscapeHtml(text));
}

std::string SvgDrawing::Finish() { return svg_ + "</svg>"; }

void DrawState(const SvgBox& box, LoadClass load_class, SvgDrawing& drawing) {
  const Rgb color = ColorOf(load_class);
  switch (load_class) {
    case LoadClass::kLow: {
      constexpr double kPale = 0.25;
      Rgb pale;
      for (std::size_t i = 0; i < pale.size(); ++i) pale[i] = 1 - kPale * (1 - color[i]);
      drawing.Fill(box, pale);
      return;
    }
    case LoadClass::kMedium:
      drawing.Fill(box, color);
      drawing.Hatch(box, 1.1, true, {{0.55, 0.28, 0.0}, 0.28, ""});
      return;
    case LoadClass::kHigh: drawing.Fill(box, color); return;
    case LoadClass::kUnknown:
      drawing.Fill(box, {1, 1, 1});
      drawing.Hatch(box, 0.9, false, {{0.35, 0.38, 0.43}, 0.16, ""});
      return;
  }
}

}  // namespace kinescope::app
