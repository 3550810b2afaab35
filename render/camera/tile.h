/// A rectangle of a picture, px, from its top left corner.
#pragma once

namespace kinescope::render {

struct Tile {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

}  // namespace kinescope::render
