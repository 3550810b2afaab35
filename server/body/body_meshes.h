/// Makes the mesh files of a person's body, so that all URDF readers (RViz, Kinescope's renderer,
/// the page) show the same surface. Pure functions, any thread; mesh_cache.h writes the files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/body/custom_body_meshes.h"
#include "server/body/hand_tools.h"
#include "urdf/human_urdf.h"

namespace kinescope::app {

/// How people look, whatever their lengths are.
struct BodyAppearance {
  bool is_smooth = true;                           // false: boxes, cylinders and spheres
  std::shared_ptr<const CustomBodyMeshes> custom;  // instead of the built-in meshes; null: none
  std::shared_ptr<const HandTools> tools;          // in the hands of all people; null: none

  bool has_meshes() const { return is_smooth || tools; }
};

struct MeshFile {
  std::string name;  // "right_forearm.stl"
  std::string stl;   // content, binary STL
};

/// The meshes that the URDF of `human` names, tools not included: those of its segments, and of the
/// fingers in place of a gloved hand. `custom`: replace the built-in ones; or null.
std::vector<MeshFile> BodyMeshFiles(const urdf::HumanModel& human, const CustomBodyMeshes* custom);

/// The meshes of the hand tools: "right_tool.stl".
std::vector<MeshFile> ToolMeshFiles(const HandTools& tools, const urdf::Skeleton& skeleton);

/// All meshes of `human` with this appearance.
std::vector<MeshFile> AllMeshFiles(const BodyAppearance& appearance, const urdf::HumanModel& human);

/// A number for the meshes of the appearance and for the surfaces that this version of the program
/// makes: another way of making one gives another number. Makes a body, which takes milliseconds.
std::uint64_t HashOf(const BodyAppearance& appearance);

/// A folder name for AllMeshFiles(), such as "body-0123456789abcdef": equal files have equal names.
/// Takes microseconds. `appearance_hash`: from HashOf().
std::string MeshSetName(std::uint64_t appearance_hash, const urdf::HumanModel& human);

}  // namespace kinescope::app
