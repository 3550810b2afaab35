/// The two halves of urdf_check.h: what stands in one element, and how they hang together.
#pragma once

#include <string>
#include <vector>

#include "urdf/urdf_check.h"
#include "urdf/xml_outline.h"

namespace kinescope::urdf {

/// A mesh that is named, and where.
struct NamedMesh {
  std::string uri;
  std::string element;
  int line = 0;
};

/// One <link>, by its index. `moves`: it hangs on a joint that is not fixed.
/// @return its mass, 0 where it has none that counts.
double CheckLink(const XmlOutline& xml, int link, bool moves, std::vector<NamedMesh>& meshes,
                 std::vector<UrdfProblem>& problems);

/// One <joint>: its numbers, not what it connects.
void CheckJoint(const XmlOutline& xml, int joint, std::vector<UrdfProblem>& problems);

/// <material> of a link or of the robot.
void CheckMaterial(const XmlOutline& xml, int material, const std::string& owner,
                   std::vector<UrdfProblem>& problems);

/// All but the numbers within: names, what hangs on what, roots. Fills `report`, but for its
/// problems, which go to `problems`; @return for each element whether it is a <link> that moves.
std::vector<bool> CheckTree(const XmlOutline& xml, UrdfReport& report,
                            std::vector<UrdfProblem>& problems);

/// "link 'arm'".
std::string Called(const std::string& tag, const std::string& name);

}  // namespace kinescope::urdf
