/// Loads over time for the plot strip, from the scenes before and after a picture. Plain data.
#pragma once

#include <string>
#include <vector>

#include "core/load_class.h"

namespace kinescope::render {

struct LoadPoint {
  double secs = 0;
  double ratio = 0;  // NaN where unknown: the line is interrupted
  LoadClass load_class = LoadClass::kUnknown;
};

struct LoadCurve {
  std::string name;               // "Right elbow"
  std::vector<LoadPoint> points;  // times ascend
};

/// Immutable once a PictureSpec holds it; the pictures of a clip share it, on any thread.
struct LoadCurves {
  double from_secs = 0, to_secs = 1;  // visible range; @pre from < to
  std::vector<LoadCurve> curves;      // from top to bottom
};

}  // namespace kinescope::render
