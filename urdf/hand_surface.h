/// Builds the shape of a gloved hand, segment by segment, in their link frames, metres: smooth
/// closed surfaces, or boxes and capsules where no meshes are wanted. The palm is one surface of
/// the carpus and contains the metacarpals of the fingers. Adjacent ends are spheres of equal
/// radius about the joint, so that no gap opens at any angle. Circumferences are estimates for a
/// hand with the proportions of body_surface.cc. Pure functions, any thread.
#pragma once

#include <vector>

#include "urdf/body_surface.h"
#include "urdf/hand.h"
#include "urdf/primitive_body.h"

namespace kinescope::urdf {

/// The closed surface of the segment; for the carpus, the palm.
TriangleMesh FingerMesh(const HandSkeleton& hand, int finger);

/// The segment as a capsule; the carpus as a box. Also used as collision shapes.
std::vector<Primitive> FingerPrimitives(const HandSkeleton& hand, int finger);

/// The box of the palm in the link frame of the hand, whose mass it contains.
Primitive PalmBoxInHand(const HandSkeleton& hand);

}  // namespace kinescope::urdf
