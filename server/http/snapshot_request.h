/// A picture of the newest state that a client asks for. Plain value.
#pragma once

#include <string>

#include "core/picture_limits.h"

namespace kinescope::http {

struct SnapshotRequest {
  std::string camera;                  // "": that of the live picture
  int width = kDefaultPictureWidth;    // px
  int height = kDefaultPictureHeight;  // px
  bool is_dark = false;                // the theme
};

}  // namespace kinescope::http
