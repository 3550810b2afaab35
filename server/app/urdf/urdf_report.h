/// Writes the report of `kinescope urdf check`. Pure functions, any thread.
#pragma once

#include <string>

#include "urdf/robot/urdf_check.h"

namespace kinescope::app {

/// Lines of text: a summary, each problem as `file:line: kind: ...`, and the result. Of problems
/// that differ only by element, the first few are listed.
std::string UrdfReportText(const std::string& file, const urdf::UrdfReport& report);

/// One JSON object with all problems, and a line end.
std::string UrdfReportJson(const std::string& file, const urdf::UrdfReport& report);

}  // namespace kinescope::app
