/// What `kinescope urdf check` says.
#pragma once

#include <string>

#include "urdf/urdf_check.h"

namespace kinescope::app {

/// Lines of text: what it is, each problem as `file:line: kind: ...`, and the verdict. Of problems
/// that only differ by element, the first few.
std::string UrdfReportText(const std::string& file, const urdf::UrdfReport& report);

/// One JSON object with all of them, and a line end.
std::string UrdfReportJson(const std::string& file, const urdf::UrdfReport& report);

}  // namespace kinescope::app
