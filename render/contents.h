/// What a picture shows, as a person would name it: things and texts, with their places. Read from
/// a second drawing of the same scene by the same code, in which each thing has a number for a
/// colour. Units: px of the picture, y downwards.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/tile.h"

namespace kinescope::render {

/// A thing of which at least one pixel is seen.
struct SeenObject {
  std::string name;           // "body", "left_knee", "centre of pressure"
  int character = -1;         // of the person whose it is; -1: it is none's
  std::string view;           // of several in a picture; "": there is one
  std::int64_t pixels = 0;    // in which it is in front
  std::int64_t through = 0;   // in which it shines through what is in front
  double x_px = 0, y_px = 0;  // the middle of all of them
  Tile box;                   // around all of them
};

struct PaintedText {
  std::string text;
  std::string part;           // "title", "status", "legend", "time", "names", "plot", ...
  double x_px = 0, y_px = 0;  // upper left corner
  double width_px = 0, height_px = 0;
};

struct PictureContents {
  std::vector<SeenObject> objects;
  std::vector<PaintedText> texts;  // in the order of painting
};

}  // namespace kinescope::render
