#include "render/label_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope::render {
namespace {

struct Rect {
  double left, top, right, bottom;
};

bool Overlap(const Rect& a, const Rect& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

// Around where it would like to be, nearest first; above before below, so that what stands on the
// floor stays free.
constexpr std::array<std::array<double, 2>, 8> kLabelDirections = {
    {{0, -1}, {0, 1}, {1, 0}, {-1, 0}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}}};
constexpr int kRings = 8;

std::optional<Rect> FindRoom(const LabelBox& box, const std::vector<Rect>& taken, double width,
                             double height) {
  const auto at = [&](double x, double y) -> std::optional<Rect> {
    // Whatever is in the picture is named inside it.
    double left = x - box.width / 2, top = y - box.height / 2;
    if (box.may_move) {
      left = std::clamp(left, 0.0, std::max(0.0, width - box.width));
      top = std::clamp(top, 0.0, std::max(0.0, height - box.height));
    }
    const Rect rect{left, top, left + box.width, top + box.height};
    const bool is_free = std::none_of(taken.begin(), taken.end(),
                                      [&](const Rect& other) { return Overlap(rect, other); });
    return is_free ? std::optional<Rect>(rect) : std::nullopt;
  };
  if (auto room = at(box.x, box.y)) return room;
  for (int ring = 1; ring <= kRings && box.may_move; ++ring) {
    for (const auto& direction : kLabelDirections) {
      // Sideways half a label at a time, up and down a line.
      if (auto room = at(box.x + direction[0] * ring * 0.5 * box.width,
                         box.y + direction[1] * ring * box.height)) {
        return room;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::optional<LabelPlace>> PlaceLabels(const std::vector<LabelBox>& boxes,
                                                   double picture_width, double picture_height) {
  std::vector<std::optional<LabelPlace>> places(boxes.size());
  std::vector<Rect> taken;
  for (std::size_t i = 0; i < std::min(boxes.size(), kMaxLabels); ++i) {
    const LabelBox& box = boxes[i];
    // Said so that NaN is outside too.
    const bool is_inside =
        box.x >= 0 && box.x <= picture_width && box.y >= 0 && box.y <= picture_height;
    if (!is_inside) continue;
    const auto room = FindRoom(box, taken, picture_width, picture_height);
    if (!room) continue;
    taken.push_back(*room);
    const double x = 0.5 * (room->left + room->right), y = 0.5 * (room->top + room->bottom);
    const bool is_moved =
        std::abs(x - box.x) > 0.5 * box.width || std::abs(y - box.y) > 0.75 * box.height;
    places[i] = LabelPlace{room->left, room->top, is_moved};
  }
  return places;
}

}  // namespace kinescope::render
