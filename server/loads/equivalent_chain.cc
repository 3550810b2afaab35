#include "server/loads/equivalent_chain.h"

namespace kinescope::loads {

using Eigen::Vector3d;
using urdf::At;
using urdf::kSegmentCount;

EquivalentChain EquivalentChainOf(const urdf::Skeleton& skeleton,
                                  const urdf::BodyParameters& body) {
  std::array<double, kSegmentCount> mass_from_here{};  // of the segment and all beyond it
  EquivalentChain chain{};
  for (int i = kSegmentCount - 1; i >= 0; --i) {  // children have higher numbers
    mass_from_here[At(i)] += body[At(i)].mass;
    chain[At(i)] += body[At(i)].mass * body[At(i)].com_in_link;
    if (i == 0) break;
    const int parent = urdf::kSegments[At(i)].parent;
    mass_from_here[At(parent)] += mass_from_here[At(i)];
    chain[At(parent)] += mass_from_here[At(i)] * skeleton.origin_in_parent[At(i)];
  }
  for (Vector3d& vector : chain) vector /= mass_from_here[urdf::kPelvis];
  return chain;
}

Vector3d CenterOfMassOf(const EquivalentChain& chain, const urdf::LinkPoses& links) {
  Vector3d com = links[urdf::kPelvis].position;
  for (std::size_t i = 0; i < chain.size(); ++i) com += links[i].orientation * chain[i];
  return com;
}

}  // namespace kinescope::loads
