/// Builds the smooth body model: one closed triangle surface per segment, in its link frame,
/// metres. Lengths follow the skeleton, circumferences the stature. Neighbouring segments overlap
/// in rounded ends about their common joint, so that no gap opens when it bends. Pure functions,
/// any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;                 // one per vertex, outward, unit length
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

/// The surface of `segment` (urdf::Segment): one closed shell; six for a hand (palm and fingers).
TriangleMesh SegmentMesh(const Skeleton& skeleton, int segment);

/// The mesh as a binary STL file: little-endian, one normal per triangle.
std::string ToBinaryStl(const TriangleMesh& mesh);

}  // namespace kinescope::urdf
