/// The visuals of a person's URDF as one mesh with a part for each of the 23 segments.
#pragma once

#include "render/vtk/visual_mesh.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

/// Part = urdf::Segment. Links other than the 23 of the human are left out.
VisualMesh MakeFigureMesh(const PersonModel& model);

}  // namespace kinescope::render
