/// The option --marks: the file of marks of a server, for pictures and reports of what it recorded.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/marks/mark_track.h"
#include "server/options/option_list.h"

namespace kinescope::app {

/// For --help.
inline constexpr const char* kMarksHelp =
    "file of marks (--marks_file of serve): what was marked at the time code of a sample is shown, "
    "of a ROS bag what was marked at its stamp";

/// Empty without a file. `is_of_ros`: for a recording of ROS. @throws UsageError with the reason
marks::MarkTrack ReadTrack(const options::FilePath& value, bool is_of_ros);

/// As pictures and reports show it: "3  belt slipped".
std::string CaptionOf(const marks::Mark& mark);
/// Of all that a picture of `state` tells.
std::vector<std::string> CaptionsAt(const marks::MarkTrack& track, const SceneState& state);

}  // namespace kinescope::app
