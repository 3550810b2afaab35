/// The option --marks: the file of marks of a server, for pictures and reports of what it recorded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/marks/mark_track.h"
#include "server/options/option_list.h"

namespace kinescope::app {

/// Any file; "": none.
class MarksValue : public options::ValueOf<std::string> {
 public:
  MarksValue() : ValueOf({}) {}

  void Parse(const std::string& text) override { value_ = text; }
  std::string ToText() const override { return value_; }
  std::string Expected() const override { return ""; }
  bool IsGiven() const override { return !value_.empty(); }
  std::vector<std::filesystem::path> Files() const override;
};

/// For --help.
inline constexpr const char* kMarksHelp =
    "file of marks (--marks_file of serve): what was marked at the time code of a sample is shown";

/// Empty without a file. @throws UsageError with the reason
marks::MarkTrack ReadTrack(const MarksValue& value);

/// As pictures and reports show it: "3  belt slipped".
std::string CaptionOf(const marks::Mark& mark);
/// Of all that a picture of `state` tells.
std::vector<std::string> CaptionsAt(const marks::MarkTrack& track, const SceneState& state);

}  // namespace kinescope::app
