/// Writes a motion as MVNX 4, one file per person: FILE.mvnx for the first, FILE_2.mvnx for the
/// second, in the order of their appearance.
#pragma once

#include <memory>
#include <string>

#include "server/app/convert/motion_file.h"

namespace kinescope::app {

std::unique_ptr<MotionFile> MakeMotionMvnx(const std::string& path, const MotionOutline& outline);

}  // namespace kinescope::app
