/// Where the load spheres lie in a picture, and which class the picture itself shows there: what a
/// golden check says in words ("right_elbow shows orange, expected green").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/image.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

struct SphereInPicture {
  int character = 0;       // whose
  std::string joint;       // "right_elbow"
  LoadClass load_class = LoadClass::kUnknown;  // what the state says
  double ratio = 0;        // of capacity; NaN where unknown
  double x_px = 0, y_px = 0, radius_px = 0;    // of the picture; the centre may lie outside
  double depth_m = 0;
  bool is_readable = false;  // centre inside the picture and not behind another sphere
};

/// In the order of people and their loads. @pre width_px, height_px > 0
std::vector<SphereInPicture> LocateSpheres(const SceneState& state, const Camera& camera,
                                           int width_px, int height_px);

/// "green", "orange", "red", "grey": the colours of palette.h by their everyday names.
const char* ColorName(LoadClass load_class);

/// The class whose colour most pixels around the sphere's centre have, by hue, so shading and the
/// body that a hidden sphere shines through do not matter. nullopt: not readable, or no clear answer.
std::optional<LoadClass> ClassShown(const Image& image, const SphereInPicture& sphere);

/// One line for each readable sphere whose picture contradicts the state. Empty: all agree.
std::vector<std::string> FindSphereMismatches(const Image& image,
                                              const std::vector<SphereInPicture>& spheres);

}  // namespace kinescope::render
