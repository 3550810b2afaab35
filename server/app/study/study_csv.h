/// Writes a study as CSV for R and pandas: a row for each trial and joint, and one for each trial
/// without loads. Writes a file; one thread.
#pragma once

#include <string>

#include "server/app/study/study.h"

namespace kinescope::app {

/// `path` "-": standard output. @throws std::runtime_error with the path and the reason.
void WriteStudyCsv(const Study& study, const std::string& path);

}  // namespace kinescope::app
