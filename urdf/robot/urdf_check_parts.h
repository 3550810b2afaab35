/// The two parts of urdf_check.h: checks within one element, and checks of the links between
/// elements. Pure functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "urdf/robot/urdf_check.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::urdf {

/// A mesh reference and where it occurs.
struct NamedMesh {
  std::string uri;
  std::string element;
  int line = 0;
};

/// Checks one <link>, given by its index. `moves`: its joint is not fixed.
/// @return its mass, kg; 0 if it has no valid mass.
double CheckLink(const XmlOutline& xml, int link, bool moves, std::vector<NamedMesh>& meshes,
                 std::vector<UrdfProblem>& problems);

/// Checks one <joint>: its numbers, not the links that it connects.
void CheckJoint(const XmlOutline& xml, int joint, std::vector<UrdfProblem>& problems);

/// Checks the <material> of a link or of the robot.
void CheckMaterial(const XmlOutline& xml, int material, const std::string& owner,
                   std::vector<UrdfProblem>& problems);

/// Checks names, parents, children and roots. Fills `report` except for its problems, which are
/// added to `problems`; @return for each element whether it is a <link> that moves.
std::vector<bool> CheckTree(const XmlOutline& xml, UrdfReport& report,
                            std::vector<UrdfProblem>& problems);

/// "link 'arm'".
std::string Called(const std::string& tag, const std::string& name);

}  // namespace kinescope::urdf
