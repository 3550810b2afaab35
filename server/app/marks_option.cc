#include "server/app/marks_option.h"

#include "core/system/errors.h"
#include "server/marks/mark_file.h"

namespace kinescope::app {

marks::MarkTrack ReadTrack(const options::FilePath& value, bool is_of_ros) {
  if (!value.IsGiven()) return {};
  const auto marks = marks::ReadMarks(*value);
  if (!marks) throw UsageError("--marks=" + marks.error());
  return {*marks, is_of_ros ? marks::TrackClock::kStamp : marks::TrackClock::kTimeCode};
}

std::string CaptionOf(const marks::Mark& mark) {
  const std::string number = mark.button > 0 ? std::to_string(mark.button) + "  " : "";
  return number + mark.text;
}

std::vector<std::string> CaptionsAt(const marks::MarkTrack& track, const SceneState& state) {
  std::vector<std::string> captions;
  for (const marks::TrackMark* const each : track.At(state)) {
    captions.push_back(CaptionOf(each->mark));
  }
  return captions;
}

}  // namespace kinescope::app
