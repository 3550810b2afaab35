/// Writes the person's surface as mesh files, so that all URDF readers (RViz, Kinescope's renderer,
/// the page) show the same body. Any thread.
#pragma once

#include <string>
#include <vector>

#include "server/body/custom_body_meshes.h"
#include "server/body/hand_tools.h"
#include "urdf/human_urdf.h"

namespace kinescope::app {

struct MeshFile {
  std::string name;  // "right_forearm.stl"
  std::string stl;   // content, binary STL
};

/// All meshes that the URDF of `human` names: those of its segments, and of the fingers in place of
/// a gloved hand. `own`: the user's custom meshes, which replace the built-in ones; or null.
std::vector<MeshFile> BodyMeshFiles(const urdf::HumanModel& human, const CustomBodyMeshes* own);

/// The meshes of the hand tools: "right_tool.stl".
std::vector<MeshFile> ToolMeshFiles(const HandTools& tools, const urdf::Skeleton& skeleton);

/// Writes `files` once into a folder of the user's cache ($XDG_CACHE_HOME/kinescope,
/// ~/.cache/kinescope, else the temporary folder) that is named after their content; returns that
/// folder. Returns "" if it cannot be written, and logs this once: the body then consists of
/// primitives, and tools are not shown.
std::string WriteToCache(const std::vector<MeshFile>& files);

}  // namespace kinescope::app
