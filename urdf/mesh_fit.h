/// Somebody else's mesh as the surface of a segment: brought into metres, into the link's frame and
/// onto the person. Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>

#include "urdf/figure.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

/// How a set of meshes is to be understood.
struct MeshConvention {
  enum class Frame {
    kSegment,  // MVN's: arms along y, as in the T-pose
    kLink,     // TF's: arms along -z, as in the N-pose
    kLonger,   // of these the one along which an arm's mesh is longer; for sets that mix them
  };
  double metres_per_unit = 1;
  bool y_is_up = false;  // turned about x, so that y becomes z; z is up otherwise
  Frame frame = Frame::kLonger;
  /// Stretched along its segment to the person's own length. A mesh whose origin is near its middle
  /// is moved onto its segment as well; otherwise its origin is taken for the joint.
  bool fits_person = true;
};

/// `mesh` in metres and in the link frame, in its own size. Its normals are made anew.
[[nodiscard]] TriangleMesh ToLinkFrame(TriangleMesh mesh, const MeshConvention& convention,
                                       int segment);

/// What ToLinkFrame gave, stretched along `segment` to the length that `skeleton` has there.
TriangleMesh FitToPerson(TriangleMesh mesh, const Skeleton& skeleton, int segment);

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);

}  // namespace kinescope::urdf
