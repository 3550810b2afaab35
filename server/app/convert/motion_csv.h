/// Writes a motion as one CSV table: wide (a row per sample) or long (a row per value). The last
/// column, `provenance`, says in the first row where the table comes from.
#pragma once

#include <memory>
#include <string>

#include "server/app/convert/motion_file.h"

namespace kinescope::app {

std::unique_ptr<MotionFile> MakeMotionCsv(const std::string& path, const MotionOutline& outline);

}  // namespace kinescope::app
