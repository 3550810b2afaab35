/// The vertices of one person's skin in VTK's arrays. A new pose moves them.
#pragma once

#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene_state.h"
#include "render/shape/fine_normals.h"
#include "render/shape/skin_lines.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {

class SkinSurface {
 public:
  /// `fine_normals`: where `skin` is a coarser one.
  SkinSurface(std::shared_ptr<const skin::SkinTemplate> skin, FineNormals fine_normals,
              const skin::Build& build, const PersonModel& model);

  /// To `person`, of the same model.
  void Move(const PersonState& person, const skin::Capsules& capsules);

  vtkFloatArray* positions() { return positions_; }
  vtkFloatArray* normals() { return normals_; }
  /// `paint` (borders of the suit or a colour) and `openSky`; with loads also `region`.
  std::vector<vtkFloatArray*> attributes(bool has_loads);
  const std::vector<skin::Triangle>& triangles() const { return skin_->triangles; }
  /// Of the suit at each vertex; empty: vertices have colours.
  const std::vector<skin::Borders>& suit() const { return suit_; }
  /// As moved: see SkinLines.
  void AddLines(const Camera& camera, std::vector<SpaceLine>& lines);
  /// As moved.
  const skin::PersonSkin::Surface& surface() const { return surface_; }

 private:
  void FindRegions();

  const std::shared_ptr<const skin::SkinTemplate> skin_;
  const FineNormals fine_normals_;
  const skin::Build build_;
  const skin::PersonSkin person_;
  const double stature_;
  const std::vector<skin::LimbRun> limbs_;
  std::vector<skin::Borders> suit_;
  skin::PersonSkin::Surface surface_;
  std::vector<float> open_;
  vtkNew<vtkFloatArray> positions_, normals_, paint_, open_sky_;
  vtkNew<vtkFloatArray> regions_;     // empty until loads are shown
  std::unique_ptr<SkinLines> lines_;  // null until lines are drawn
  std::vector<urdf::Pose> shown_;     // the poses of `surface_`
};

}  // namespace kinescope::render
