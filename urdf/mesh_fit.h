/// Fits a custom mesh to a segment: converts it to metres and to the link frame, and scales it to
/// the person. Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>

#include "urdf/body_surface.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

/// Units and axes of a set of meshes.
struct MeshConvention {
  enum class Frame {
    kSegment,  // MVN's: arms along y, as in the T-pose
    kLink,     // TF's: arms along -z, as in the N-pose
    kLonger,  // kSegment or kLink, along whichever the arm's mesh is longer; for sets that mix both
  };
  double metres_per_unit = 1;
  bool y_is_up = false;  // rotates about x, so that y becomes z; otherwise z is up
  Frame frame = Frame::kLonger;
  /// Stretch the mesh along its segment to the person's own segment length. A mesh with its origin
  /// near its middle is also moved onto its segment; otherwise its origin is taken as the joint.
  bool fits_person = true;
};

/// `mesh` in metres and in the link frame, in its original size. The normals are recomputed.
[[nodiscard]] TriangleMesh ToLinkFrame(TriangleMesh mesh, const MeshConvention& convention,
                                       int segment);

/// Stretches a mesh from ToLinkFrame along `segment` to the segment length of `skeleton`.
TriangleMesh FitToPerson(TriangleMesh mesh, const Skeleton& skeleton, int segment);

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);

}  // namespace kinescope::urdf
