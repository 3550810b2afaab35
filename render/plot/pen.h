/// Wraps the parts of Cairo that plots need: owns surface, context and fonts. No other file uses
/// Cairo for plots. Points (1/72 inch), y downwards. One thread.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/image/image.h"

namespace kinescope::render::plot {

class Pen {
 public:
  /// For an SVG or for a picture. @throws RenderError if a font is missing.
  static std::unique_ptr<Pen> ForSvg(double width, double height);
  static std::unique_ptr<Pen> ForImage(double width, double height, double px_per_pt);
  ~Pen();
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  void Box(double x, double y, double width, double height, const Rgb& color, double alpha = 1);
  void Disc(double x, double y, double radius, const Rgb& color);
  void Line(double x1, double y1, double x2, double y2, const Rgb& color, double width,
            const std::vector<double>& dash = {});
  /// Points with NaN interrupt it.
  void Polyline(const std::vector<std::pair<double, double>>& points, const Rgb& color,
                double width, const std::vector<double>& dash);
  /// Slanted lines across a box.
  void Hatch(double x, double y, double width, double height);

  enum class Anchor { kLeft, kMiddle, kRight };
  void Text(double x, double y, const std::string& text, double size, const Rgb& color,
            Anchor anchor = Anchor::kLeft, bool is_bold = false, bool is_upright = false);
  double TextWidth(const std::string& text, double size, bool is_bold = false);

  /// Clips all drawing to the box until Unclip.
  void Clip(double x, double y, double width, double height);
  void Unclip();

  // Call one of them once, at the end. @throws RenderError.
  std::string TakeSvg();
  Image TakeImage();

 private:
  struct Parts;
  explicit Pen(std::unique_ptr<Parts> parts);
  void UseFont(double size, bool is_bold);
  std::unique_ptr<Parts> parts_;
};

}  // namespace kinescope::render::plot
