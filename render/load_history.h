/// Loads over time, for the plot strip: what the scenes before and after a picture say.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::render {

struct LoadPoint {
  double secs = 0;
  double ratio = 0;  // NaN where unknown: the line breaks
  LoadClass load_class = LoadClass::kUnknown;
};

struct LoadCurve {
  std::string name;               // "Right elbow"
  std::vector<LoadPoint> points;  // times ascend
};

/// Immutable once a View holds it; shared by the pictures of a clip.
struct LoadHistory {
  double from_secs = 0, to_secs = 1;  // what is shown; @pre from < to
  std::vector<LoadCurve> curves;      // from top to bottom
};

}  // namespace kinescope::render
