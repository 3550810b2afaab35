/// Places labels in a picture so that none covers another. The result depends only on the labels;
/// earlier ones have priority. Pure functions, any thread. px, y downwards.
#pragma once

#include <optional>
#include <vector>

namespace kinescope::render {

struct LabelBox {
  double x = 0, y = 0;           // the labelled point; centre of the box while there is room
  double width = 0, height = 0;  // of the box, margin included
  bool may_move = true;          // false: at its point or not at all
};

struct LabelPlace {
  double left = 0, top = 0;
  bool is_moved = false;  // so far away that a line to the point is needed
};

/// One place for each of `boxes`; nullopt if its point is outside the picture, or if there is no
/// room near it. Only the first kMaxLabels are placed, the others get nullopt.
std::vector<std::optional<LabelPlace>> PlaceLabels(const std::vector<LabelBox>& boxes,
                                                   double picture_width, double picture_height);

constexpr std::size_t kMaxLabels = 300;

}  // namespace kinescope::render
