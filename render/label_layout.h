/// Where labels go in a picture so that none covers another. The same labels give the same places;
/// earlier ones come first. Pure functions, any thread. px, y downwards.
#pragma once

#include <optional>
#include <vector>

namespace kinescope::render {

struct LabelBox {
  double x = 0, y = 0;           // what it is about; the box's middle as long as there is room
  double width = 0, height = 0;  // with its margin
  bool may_move = true;          // else: there or nowhere
};

struct LabelPlace {
  double left = 0, top = 0;
  bool is_moved = false;  // far enough for a line to what it is about
};

/// One for each of `boxes`; nullopt where what it is about lies outside the picture, or where there
/// is no room anywhere near. Looks at the first kMostLabels, the rest gets nullopt.
std::vector<std::optional<LabelPlace>> PlaceLabels(const std::vector<LabelBox>& boxes,
                                                   double picture_width, double picture_height);

constexpr std::size_t kMostLabels = 300;

}  // namespace kinescope::render
