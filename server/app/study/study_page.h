/// Writes a study as one HTML file: comparison of conditions by joint, table of trials, what failed
/// and why. Without its script, a table of people and conditions is there to be read. Writes a
/// file; one thread.
#pragma once

#include <string>

#include "server/app/study/study.h"

namespace kinescope::app {

/// Links in it are relative to its folder. `csv`: of the study, "": none is written. The same study
/// gives the same bytes. @throws std::runtime_error with the path and the reason.
void WriteStudyPage(const Study& study, const std::string& title, const std::string& csv,
                    const std::string& path);

}  // namespace kinescope::app
