/// Which picture of a clip a golden picture is. A case of one picture has the name of its picture;
/// those of a clip are "walk@0030". Pure functions; any thread.
#pragma once

#include <optional>
#include <string>

namespace kinescope::app {

struct GoldenFrame {
  long number = 0;  // of the clip, from 0
  double secs = 0;  // after the first sample of the source
};

/// The sign between the name of a case and the number of a frame.
inline constexpr char kFrameSign = '@';

std::string PictureName(const std::string& case_name, const std::optional<GoldenFrame>& frame);

/// "walk" of "walk@0030", and of "walk".
std::string CaseNameOf(const std::string& picture_name);

/// "frame 30 (1.000 s)".
std::string ToText(const GoldenFrame& frame);

}  // namespace kinescope::app
