/// Finds all problems of a URDF, with line numbers. urdfdom stops at the first error, gives no
/// lines and accepts many of the problems that follow, so the elements are checked separately. Pure
/// functions, except that mesh files are looked up; any thread.
#pragma once

#include <string>
#include <vector>

#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::urdf {

struct UrdfProblem {
  enum class Kind {
    kUnreadable,  // invalid: rejected by every URDF parser, including ParseUrdf
    kWrong,       // can be rendered, but contains invalid values or references
    kWarning,     // valid, but not supported by all programs
  };
  Kind kind = Kind::kWrong;
  int line = 0;         // from 1; 0 if unknown
  std::string element;  // "link 'arm'"
  std::string what;     // what is wrong, with the value
  std::string suggestion;
};

/// "unreadable", "wrong", "warning".
const char* Name(UrdfProblem::Kind kind);

struct UrdfReport {
  std::string robot;
  std::vector<std::string> roots;
  std::size_t links = 0;
  std::size_t joints = 0;
  std::size_t moving_joints = 0;      // not fixed
  std::size_t meshes = 0;             // different names of mesh files
  double mass = 0;                    // kg, of all links
  std::vector<UrdfProblem> problems;  // ordered by line

  bool is_usable() const;  // no problems except warnings
};

/// Never throws because of the content of `xml`.
UrdfReport CheckUrdf(const std::string& xml, const MeshSearch& meshes);

/// @throws UrdfError with the line of the first problem that makes `xml` unreadable.
void RefuseUnreadable(const XmlOutline& xml);

}  // namespace kinescope::urdf
