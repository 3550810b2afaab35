/// Writes the skin of a person for the page (docs/http.md): vertices, weights, clothes or colours,
/// and how the frames that carry them follow from the streamed link poses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::http {

/// Little-endian: the length of a JSON header (u32), the header, blanks up to a multiple of 4, then
/// the arrays that it counts. Metres; the person's bind pose with the pelvis at the origin, z up.
/// `own`: instead of the built-in skin; or null. `error_mm`: how far the surface may be from the
/// whole one, for fewer triangles; 0: not at all. Any thread. @pre model.has_built_in_surface
std::string SkinBuffer(const PersonModel& model, const skin::SkinTemplate* own, int error_mm = 0);

/// The buffers that were asked for, as long as their models are in use. One thread.
class SkinBuffers {
 public:
  /// Never null. `own`: always the same.
  std::shared_ptr<const std::string> Of(const std::shared_ptr<const PersonModel>& model,
                                        const skin::SkinTemplate* own, int error_mm);

 private:
  struct Made {
    std::weak_ptr<const PersonModel> model;
    int error_mm = 0;
    std::shared_ptr<const std::string> buffer;
  };
  std::vector<Made> made_;
};

}  // namespace kinescope::http
