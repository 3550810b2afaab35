/// What a gloved hand looks like, segment by segment, in their link frames: smooth closed surfaces,
/// and boxes and capsules for those who want no meshes. The palm is one surface, which the carpus
/// carries; the metacarpals of the fingers lie in it. Ends that meet are balls of one radius about
/// the joint, so that no gap opens however it bends. Girths are by eye, for a hand of the figure's
/// proportions (figure.cc). Metres. Pure functions, any thread.
#pragma once

#include <vector>

#include "urdf/figure.h"
#include "urdf/hand.h"
#include "urdf/primitive_figure.h"

namespace kinescope::urdf {

/// The closed surface of the segment; of the carpus, the palm.
TriangleMesh FingerMesh(const HandSkeleton& hand, int finger);

/// The same as a capsule; of the carpus, a box. Also the collision shapes.
std::vector<Primitive> FingerFigure(const HandSkeleton& hand, int finger);

/// The palm's box in the link frame of the hand itself, whose mass it surrounds.
Primitive PalmBoxInHand(const HandSkeleton& hand);

}  // namespace kinescope::urdf
