/// Where the load spheres lie in a picture, and which class the picture itself shows there: what a
/// golden check says in words ("right_elbow shows orange, expected green").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera.h"
#include "render/image.h"

namespace kinescope::render {

struct SphereInPicture {
  int character = 0;                           // whose
  std::string joint;                           // "right_elbow"
  LoadClass load_class = LoadClass::kUnknown;  // what the state says
  double ratio = 0;                            // of capacity; NaN where unknown
  double x_px = 0, y_px = 0, radius_px = 0;    // of the picture; the centre may lie outside
  double depth_m = 0;                          // <= 0: behind the camera
};

/// In the order of people and their loads. @pre width_px, height_px > 0
std::vector<SphereInPicture> LocateSpheres(const SceneState& state, const Camera& camera,
                                           int width_px, int height_px);

/// "green", "orange", "red", "grey": the colours of palette.h by their everyday names.
const char* ColorName(LoadClass load_class);

struct Reading {
  bool is_readable = false;  // enough of the sphere is in the picture and not behind another one
  std::optional<LoadClass> shown;  // nullopt: not readable, or no colour has the majority
};

/// The class whose colour most pixels of `spheres[index]` have. By hue, so neither shading matters
/// nor the body through which a hidden sphere shines. `spheres`: all that are in the picture.
/// Pixels that a legend or banner covers are read like any others: read pictures drawn without
/// overlays, or keep people clear of them.
Reading ReadSphere(const Image& image, const std::vector<SphereInPicture>& spheres,
                   std::size_t index);

/// One line for each readable sphere whose picture contradicts the state. Empty: all agree.
std::vector<std::string> FindSphereMismatches(const Image& image,
                                              const std::vector<SphereInPicture>& spheres);

}  // namespace kinescope::render
