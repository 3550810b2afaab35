/// Names of ROS in options, whether or not this build has ROS: as roscpp has them, letters, digits,
/// _ and /. Pure functions, any thread.
#pragma once

#include <string>

#include "server/options/value.h"

namespace kinescope::app {

inline constexpr std::size_t kMaxMarkerTopics = 16;

/// A topic or a parameter: it begins with a letter, / or ~.
[[nodiscard]] bool IsTopicName(const std::string& text);
/// A frame, or the prefix of frames: not with / at its beginning.
[[nodiscard]] bool IsFrameName(const std::string& text);
/// At most kMaxMarkerTopics with commas between; "": none.
[[nodiscard]] bool AreTopicNames(const std::string& text);

/// --marker_topics, "" unless told.
options::Text MarkerTopics();

}  // namespace kinescope::app
