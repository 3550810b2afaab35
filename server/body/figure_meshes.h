/// A folder of the user's own meshes, one per segment, instead of our figure.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "urdf/mesh_fit.h"
#include "urdf/segments.h"

namespace kinescope::app {

struct FigureMeshes {
  std::array<std::optional<urdf::TriangleMesh>, urdf::kSegmentCount> meshes;  // link frames, m
  bool fit_person = true;  // stretched to each person's own lengths
};

/// The segment that a file of this name (without its ending) is for: `RightForeArm`,
/// `xsens_RightForeArm`, `right_forearm`, `forearm_r`, `L_ForeArm`; nullopt for any other name.
std::optional<urdf::Segment> SegmentOfFile(std::string_view stem);

/// Reads the STL, DAE, OBJ and GLB files of `folder` that are named after segments; units and up
/// axis of `convention` are those of STL and OBJ, the others tell their own. Says once on the log
/// for which segments there is none (our figure's stands in), and which files were not taken.
/// @throws UsageError naming folder or file: not there, no file for any segment, two for one,
/// a mesh that cannot be read or that is too small or too large to be part of a person.
std::shared_ptr<const FigureMeshes> ReadFigureMeshes(const std::string& folder,
                                                     const urdf::MeshConvention& convention);

/// One such file in metres and in the link frame of `segment`.
/// @throws UsageError naming `option` and the file, as ReadFigureMeshes.
urdf::TriangleMesh ReadOwnMesh(const char* option, const std::filesystem::path& path,
                               urdf::MeshConvention convention, int segment);

/// The surface of `segment`: the user's where there is one, else ours.
urdf::TriangleMesh FigureMeshOf(const FigureMeshes* own, const urdf::Skeleton& skeleton,
                                int segment);

}  // namespace kinescope::app
