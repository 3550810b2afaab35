/// What is wrong with a URDF, all of it and with lines. urdfdom stops at the first fault, has no
/// lines and does not mind much of what follows; so the elements are looked at a second time.
/// Pure functions, but for meshes, which are looked for; any thread.
#pragma once

#include <string>
#include <vector>

#include "urdf/mesh_uri.h"
#include "urdf/xml_outline.h"

namespace kinescope::urdf {

struct UrdfProblem {
  enum class Kind {
    kUnreadable,  // no reader takes it; ParseUrdf refuses it too
    kWrong,       // it can be drawn, but says what cannot be
    kWarning,     // right, but not everybody can use it
  };
  Kind kind = Kind::kWrong;
  int line = 0;         // from 1; 0 where it is not known
  std::string element;  // "link 'arm'"
  std::string what;     // with the value
  std::string way_out;
};

/// "unreadable", "wrong", "warning".
const char* Name(UrdfProblem::Kind kind);

struct UrdfReport {
  std::string robot;
  std::vector<std::string> roots;
  std::size_t links = 0;
  std::size_t joints = 0;
  std::size_t moving_joints = 0;      // neither fixed
  std::size_t meshes = 0;             // different names
  double mass = 0;                    // kg, of all links
  std::vector<UrdfProblem> problems;  // by line

  bool is_usable() const;  // nothing but warnings
};

/// Never throws for anything that `xml` holds.
UrdfReport CheckUrdf(const std::string& xml, const MeshSearch& meshes);

/// @throws UrdfError with the line of the first thing that no reader takes.
void RefuseUnreadable(const XmlOutline& xml);

}  // namespace kinescope::urdf
