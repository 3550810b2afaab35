/// What `kinescope inspect` found, for people and for programs.
#pragma once

#include <string>

#include "server/mvn/inspect/inspection.h"

namespace kinescope::app {

/// Several lines, aligned; ends with a line break.
std::string ReportText(const mvn::InspectionReport& report);

/// One object (docs/inspect.md).
std::string ReportJson(const mvn::InspectionReport& report);

}  // namespace kinescope::app
