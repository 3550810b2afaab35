/// Locates the load spheres in a picture, and reads which class the picture shows there, for the
/// messages of golden checks ("right_elbow shows orange, expected green"). Pure functions, any
/// thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/image/image.h"

namespace kinescope::render {

struct SphereInPicture {
  int character = 0;                           // of the person
  std::string joint;                           // "right_elbow"
  LoadClass load_class = LoadClass::kUnknown;  // according to the state
  double ratio = 0;                            // of the capacity; NaN where unknown
  double x_px = 0, y_px = 0, radius_px = 0;    // in the picture; the centre may be outside
  double depth_m = 0;                          // m; <= 0: behind the camera
};

/// In the order of people and their loads. @pre width_px, height_px > 0
std::vector<SphereInPicture> LocateSpheres(const SceneState& state, const Camera& camera,
                                           int width_px, int height_px);

/// "green", "orange", "red", "grey": everyday names of the colours in palette.h.
const char* ColorName(LoadClass load_class);

struct Reading {
  bool is_readable = false;        // enough of the sphere is inside the picture and not covered by
                                   // another one
  std::optional<LoadClass> shown;  // nullopt: not readable, or no majority of a colour
};

/// The class with the colour of most pixels of `spheres[index]`. It compares hues, so neither
/// shading matters nor the body in front of a sphere that shines through. `spheres`: all spheres in
/// the picture. Pixels under a legend or banner are read as well: use pictures without overlays, or
/// keep people away from them.
Reading ReadSphere(const Image& image, const std::vector<SphereInPicture>& spheres,
                   std::size_t index);

/// One line per readable sphere whose picture contradicts the state. Empty: no contradiction.
std::vector<std::string> FindSphereMismatches(const Image& image,
                                              const std::vector<SphereInPicture>& spheres);

}  // namespace kinescope::render
