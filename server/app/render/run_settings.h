/// How a render run is executed; nothing here changes a pixel. Plain data.
#pragma once

#include <optional>

namespace kinescope::app {

struct RunSettings {
  int jobs = 1;
  bool force = false;                // also renders outputs that are up to date
  bool sidecar = true;               // write FILE.json
  std::optional<long> only_picture;  // of clips and sequences: only this picture
};

}  // namespace kinescope::app
