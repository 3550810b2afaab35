/// The person's surface as mesh files, so that URDF readers (RViz, our own renderer, the
/// page) all show the same body.
#pragma once

#include <string>

#include "server/app/figure_meshes.h"
#include "urdf/skeleton.h"

namespace kinescope::app {

/// Writes one binary STL per link into a folder of the user's cache ($XDG_CACHE_HOME/kinescope,
/// ~/.cache/kinescope, else the temporary folder) that is named after their content, once; returns
/// that folder. "" when nothing can be written: the figure is then made of primitives. Says so once
/// on the log. `own`: the user's meshes, where they take the place of ours; else null.
std::string WriteFigureFiles(const urdf::Skeleton& skeleton, const FigureMeshes* own = nullptr);

}  // namespace kinescope::app
