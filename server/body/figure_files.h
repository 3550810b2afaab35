/// The person's surface as mesh files, so that URDF readers (RViz, our own renderer, the
/// page) all show the same body.
#pragma once

#include <string>
#include <vector>

#include "server/body/figure_meshes.h"
#include "server/body/hand_tools.h"
#include "urdf/human_urdf.h"

namespace kinescope::app {

struct FigureFile {
  std::string name;  // "right_forearm.stl"
  std::string stl;   // binary
};

/// All meshes that the URDF of `human` names: those of its segments, and of the fingers in place of
/// a gloved hand. `own`: the user's meshes, where they take the place of ours; else null.
std::vector<FigureFile> FigureFiles(const urdf::HumanModel& human, const FigureMeshes* own);

/// Those of what the hands hold: "right_tool.stl".
std::vector<FigureFile> ToolFiles(const HandTools& tools, const urdf::Skeleton& skeleton);

/// Writes `files` into a folder of the user's cache ($XDG_CACHE_HOME/kinescope, ~/.cache/kinescope,
/// else the temporary folder) that is named after their content, once; returns that folder. ""
/// when nothing can be written: the figure is then made of primitives, and tools are not seen. Says
/// so once on the log.
std::string WriteToCache(const std::vector<FigureFile>& files);

}  // namespace kinescope::app
