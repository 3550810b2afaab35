/// The option --rviz: a configuration of RViz 1, from which pictures take what they can.
#pragma once

#include "server/options/option_list.h"

namespace kinescope::app {

/// For --help.
inline constexpr const char* kRvizHelp =
    "configuration of RViz 1 (FILE.rviz) with the camera and what is drawn; options that are given "
    "come before it, and what is drawn otherwise than in RViz is listed (docs/rviz_files.md)";

/// Sets those of `list` that were not given, and logs a warning for each thing that RViz would draw
/// and we do not. @param height_px  of the picture. @throws UsageError as ReadRvizFile(), or for an
/// option that has no effect with the others now
void ApplyRviz(const options::FilePath& file, int height_px, options::OptionList& list);

}  // namespace kinescope::app
