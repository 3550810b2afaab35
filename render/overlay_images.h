/// Paints the pictures of cameras at the right edge of a picture, above the time code. Internal to
/// overlay*.cc.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/camera_image.h"
#include "core/scene_state.h"
#include "render/legend.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// px
struct ImagePlace {
  int left = 0, top = 0, width = 0, height = 0;
};
/// From the lowest one upwards. @param has_plot  above them
std::vector<ImagePlace> PlacesOfImages(const OverlaySizes& sizes,
                                       const std::vector<ImageSize>& images, bool has_plot);

/// Remembers what it has decoded: most pictures come again in the next one that is drawn. One
/// thread.
class OverlayImages {
 public:
  /// Draws the scene over the pixels of an image, as its camera sees it.
  using DrawScene = std::function<void(const ImageCamera& camera, Image& pixels)>;

  /// @param draw_scene  null: images are painted without it
  void Paint(OverlayPage& page, const SceneState& state, bool has_plot,
             const DrawScene& draw_scene);

 private:
  struct Decoded {
    std::shared_ptr<const CameraImage> of;
    int width = 0, height = 0;  // at most
    Image pixels;
    std::string problem;  // of an image that cannot be decoded
  };
  const Decoded& Decode(std::size_t i, const std::shared_ptr<const CameraImage>& image, int width,
                        int height);

  std::vector<Decoded> decoded_;  // by place
};

}  // namespace kinescope::render
