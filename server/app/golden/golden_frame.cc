#include "server/app/golden/golden_frame.h"

#include <fmt/format.h>

namespace kinescope::app {

std::string PictureName(const std::string& case_name, const std::optional<GoldenFrame>& frame) {
  return frame ? fmt::format("{}{}{:04}", case_name, kFrameSign, frame->number) : case_name;
}

std::string CaseNameOf(const std::string& picture_name) {
  return picture_name.substr(0, picture_name.rfind(kFrameSign));
}

std::string ToText(const GoldenFrame& frame) {
  return fmt::format("frame {} ({:.3f} s)", frame.number, frame.secs);
}

}  // namespace kinescope::app
