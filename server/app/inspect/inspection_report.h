/// Writes the report of `kinescope inspect` as text and as JSON. Pure functions, any thread.
#pragma once

#include <string>

#include "server/mvn/inspect/inspection.h"

namespace kinescope::app {

/// Several aligned lines; ends with a line break.
std::string ReportText(const mvn::InspectionReport& report);

/// One JSON object (docs/inspect.md).
std::string ReportJson(const mvn::InspectionReport& report);

}  // namespace kinescope::app
