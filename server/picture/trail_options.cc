#include "server/picture/trail_options.h"

#include <fmt/format.h>

#include "urdf/segments.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMaxTrails = 24;

std::vector<std::string> TrackNames() {
  std::vector<std::string> names = {"com"};
  for (const urdf::SegmentInfo& segment : urdf::kSegments) names.emplace_back(segment.link_name);
  return names;
}

int TrackNamed(const std::string& name) {
  if (name == "com") return -1;
  for (std::size_t i = 0; i < urdf::kSegments.size(); ++i) {
    const urdf::SegmentInfo& segment = urdf::kSegments[i];
    if (name == segment.mvn_name || name == segment.link_name) return static_cast<int>(i);
  }
  options::RefuseWord(name, TrackNames());
}

}  // namespace

TrailOptions::TrailOptions()
    : points(fmt::format("{}", fmt::join(TrackNames(), ",")), kMaxTrails, TrackNamed),
      secs(2, {0, Trails::kMaxSecs, "s", true}) {}

void TrailOptions::List(options::OptionList& option) {
  option("trail", points, "points whose recent path is drawn");
  option("trail_secs", secs, "length of the trails");
  option.HasNoEffect("trail_secs", "without --trail", [this] { return points->empty(); });
}

}  // namespace kinescope::app
