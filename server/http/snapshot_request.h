/// A picture that a client asks for. Plain value.
#pragma once

#include <memory>
#include <string>

#include "core/picture_limits.h"
#include "core/scene_state.h"

namespace kinescope::http {

struct SnapshotRequest {
  std::string camera;                                 // "": that of the live picture
  int width = kDefaultPictureWidth;                   // px
  int height = kDefaultPictureHeight;                 // px
  bool is_dark = false;                               // the theme
  std::shared_ptr<const SceneState> state = nullptr;  // a former one; null: the newest
};

}  // namespace kinescope::http
