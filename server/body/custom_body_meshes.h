/// Reads a folder of the user's custom meshes, one per segment, which replace the built-in body
/// model. Any thread.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "urdf/mesh_fit.h"
#include "urdf/segments.h"

namespace kinescope::app {

struct CustomBodyMeshes {
  std::array<std::optional<urdf::TriangleMesh>, urdf::kSegmentCount> meshes;  // link frames, m
  bool fit_person = true;  // stretched to each person's segment lengths
};

/// The segment of a file with this name (without extension): `RightForeArm`, `xsens_RightForeArm`,
/// `right_forearm`, `forearm_r`, `L_ForeArm`; nullopt for any other name.
std::optional<urdf::Segment> SegmentOfFile(std::string_view stem);

/// Reads the STL, DAE, OBJ and GLB files of `folder` that are named after segments. Units and up
/// axis of `convention` apply to STL and OBJ; the other formats contain them. Logs once which
/// segments have no file (the built-in mesh is used) and which files were skipped. @throws
/// UsageError with the folder or file: missing folder, no file for any segment, two files for one
/// segment, a mesh that cannot be read or whose size cannot be that of a body part.
std::shared_ptr<const CustomBodyMeshes> ReadCustomBodyMeshes(
    const std::string& folder, const urdf::MeshConvention& convention);

/// The files that ReadCustomBodyMeshes() would read, and those behind them. Empty where it would
/// throw.
std::vector<std::filesystem::path> FilesOfCustomBody(const std::string& folder);

/// One such file, in metres and in the link frame of `segment`.
/// @throws UsageError with `option` and the file, as ReadCustomBodyMeshes.
urdf::TriangleMesh ReadOwnMesh(const char* option, const std::filesystem::path& path,
                               urdf::MeshConvention convention, int segment);

/// The surface of `segment`: the user's mesh if there is one, else the built-in one.
urdf::TriangleMesh BodyMeshOf(const CustomBodyMeshes* own, const urdf::Skeleton& skeleton,
                              int segment);

}  // namespace kinescope::app
