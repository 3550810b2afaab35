/// Notes the texts of a picture instead of painting them. One thread.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/contents.h"
#include "render/painter.h"

namespace kinescope::render {

class TextNotes : public Painter {
 public:
  /// What was noted, in the order of painting.
  std::vector<PaintedText> Take() { return std::move(texts_); }

  void Begin(std::string_view part) override { part_ = part; }
  void Enter(const Tile& part) override { area_ = part; }
  void RoundedBox(double, double, double, double, double, const Ink&) override {}
  void Disc(double, double, double, const Ink&) override {}
  void Ring(double, double, double, double, const Ink&) override {}
  void Polyline(const std::vector<std::pair<double, double>>&, double, const Ink&) override {}
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink&) override {
    const double width = font.Width(utf8, size_px);
    if (!utf8.empty()) {
      texts_.push_back(
          {std::string(utf8), part_, area_.x + x, area_.y + y - size_px, width, 1.25 * size_px});
    }
    return x + width;
  }

 private:
  std::string part_;
  Tile area_;
  std::vector<PaintedText> texts_;
};

}  // namespace kinescope::render
