/// The pictures of cameras as files for the page. One thread: the page's.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/camera_image.h"

namespace kinescope::app {

class CameraFiles {
 public:
  /// A JPEG of at most 640 x 480 px, or as it came if that is small; the same one for all viewers.
  /// Null: it cannot be decoded. @param number  of the image in SceneState::images
  std::shared_ptr<const std::string> Of(std::size_t number,
                                        const std::shared_ptr<const CameraImage>& image);

 private:
  struct Made {
    std::shared_ptr<const CameraImage> of;
    std::shared_ptr<const std::string> file;
  };
  std::vector<Made> made_;  // by number
};

}  // namespace kinescope::app
