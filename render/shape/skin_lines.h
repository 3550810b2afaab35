/// The lines of a drawing of a person: outlines, creases where the body presses against itself,
/// borders of the suit, lines of the face. One thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/camera/camera.h"
#include "render/shape/face_lines.h"
#include "render/shape/visible_lines.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {

class SkinLines {
 public:
  /// @param rest positions of `skin` on the person, m
  /// @param suit of each vertex; empty: a skin of the user's own, without suit and known face
  SkinLines(const skin::SkinTemplate& skin, const skin::Build& build,
            std::vector<Eigen::Vector3f> rest, std::vector<skin::Borders> suit);

  /// Those of the posed `surface`, world, m. The outlines are those that `camera` sees, the face
  /// has lines where they are large enough.
  void AddTo(std::vector<SpaceLine>& lines, const skin::PersonSkin::Surface& surface,
             const Camera& camera) const;

 private:
  const std::vector<Eigen::Vector3f> rest_;
  const std::vector<skin::Borders> suit_;
  std::vector<std::uint32_t> triangles_;  // three vertices each
  std::optional<FaceLines> face_;
};

}  // namespace kinescope::render
