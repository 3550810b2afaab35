/// Builds a drawing as inline SVG for the report. Text stays text: it can be searched, and it has
/// the font of the page. Only elements that browsers and PDF converters draw alike are used; areas
/// are hatched line by line, since patterns are not among them. Lengths in millimetres on paper, y
/// downwards. One thread.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/palette.h"

namespace kinescope::app {

struct SvgBox {
  double left = 0, top = 0, width = 0, height = 0;
};

struct SvgStroke {
  Rgb color = {0.13, 0.15, 0.19};
  double width = 0.2;
  std::string dash;  // "1 0.6": on and off; "": solid
};

enum class SvgAnchor { kStart, kMiddle, kEnd };

struct SvgText {
  SvgAnchor anchor = SvgAnchor::kStart;
  bool is_bold = false;
  Rgb color = {0.13, 0.15, 0.19};
};

/// 7.1 pt: the only size of text in drawings.
inline constexpr double kSvgTextMm = 2.5;

class SvgDrawing {
 public:
  using Points = std::vector<std::pair<double, double>>;

  /// `description`: for screen readers.
  SvgDrawing(double width_mm, double height_mm, std::string_view description);

  void Fill(const SvgBox& box, const Rgb& color);
  void Outline(const SvgBox& box, const SvgStroke& stroke);
  /// Parallel lines, `pitch` apart; rising to the right, or falling.
  void Hatch(const SvgBox& box, double pitch, bool rises, const SvgStroke& stroke);
  /// NaN as y interrupts the line.
  void Line(const Points& points, const SvgStroke& stroke);
  void Area(const Points& points, const Rgb& color);
  /// Hollow dots are white inside.
  void Dot(double x, double y, double radius, bool is_filled);
  /// At the baseline. `text` is escaped.
  void Text(double x, double y, std::string_view text, const SvgText& look = {});

  /// The <svg> element. @pre called once
  std::string Finish();

 private:
  std::string svg_;
};

/// Of a load class in tables and timelines: different in colour, in grey and in pattern.
/// Unknown: white, hatched; low: pale; medium: hatched; high: dark.
void DrawState(const SvgBox& box, LoadClass load_class, SvgDrawing& drawing);

}  // namespace kinescope::app
