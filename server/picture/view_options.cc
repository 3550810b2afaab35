#include "server/picture/view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/errors.h"
#include "server/options/choose.h"
#include "server/picture/look_options.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostViews = 16, kMostPlots = 8;

constexpr std::array<std::pair<const char*, bool render::OverlayParts::*>, 9> kParts = {{
    {"title", &render::OverlayParts::title},
    {"lamp", &render::OverlayParts::lamp},
    {"legend", &render::OverlayParts::legend},
    {"time", &render::OverlayParts::time},
    {"names", &render::OverlayParts::names},
    {"banner", &render::OverlayParts::banner},
    {"scale", &render::OverlayParts::scale},
    {"strip", &render::OverlayParts::strip},
    {"plot", &render::OverlayParts::plot},
}};

// "a,b,,c": {"a", "b", "", "c"}; "": nothing.
std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size() || (begin == text.size() && begin > 0);) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool render::OverlayParts::*PartOf(const std::string& text, const std::string& name) {
  std::string known;
  for (const auto& [each, part] : kParts) {
    if (name == each) return part;
    known += std::string(known.empty() ? "" : " ") + each;
  }
  throw UsageError(fmt::format("--overlay={}: '{}' is not known; there are {}", text, name, known));
}

}  // namespace

render::OverlayParts ToOverlayParts(const std::string& text) {
  render::OverlayParts parts;
  const std::vector<std::string> names = Split(text, ',');
  const auto is_change = [](const std::string& name) {
    return !name.empty() && (name[0] == '+' || name[0] == '-');
  };
  if (!names.empty() && std::none_of(names.begin(), names.end(), is_change)) {
    for (const auto& [name, part] : kParts) parts.*part = false;
  }
  const bool are_changes = !names.empty() && is_change(names.front());
  for (const std::string& name : names) {
    if (is_change(name) != are_changes) {
      throw UsageError(fmt::format(
          "--overlay={}: expected either names alone, or each with + or - before it", text));
    }
    parts.*PartOf(text, are_changes ? name.substr(1) : name) = !are_changes || name[0] == '+';
  }
  return parts;
}

std::vector<int> ToPlotJoints(const std::string& text) {
  std::vector<int> joints;
  for (const std::string& name : Split(text, ',')) {
    std::string known;
    const auto found =
        std::find_if(urdf::kScoredJoints.begin(), urdf::kScoredJoints.end(), [&](int joint) {
          const std::string_view ros_name = urdf::kJoints[urdf::At(joint)].ros_name;
          known += (known.empty() ? "" : " ") + std::string(ros_name);
          return ros_name == name;
        });
    if (found == urdf::kScoredJoints.end()) {
      throw UsageError(fmt::format("--plot={}: '{}' has no load; there are {}", text, name, known));
    }
    joints.push_back(*found);
  }
  if (joints.size() > kMostPlots) {
    throw UsageError(
        fmt::format("--plot={}: {} joints, expected at most {}", text, joints.size(), kMostPlots));
  }
  return joints;
}

ViewGrid ToViewGrid(const std::string& views) {
  static const std::array<std::pair<const char*, const char*>, 4> shorthands = {{
      {"2x1", "front,right"},
      {"1x2", "front/right"},
      {"3x1", "front,right,top"},
      {"2x2", "front,right/top,three_quarter"},
  }};
  for (const auto& [name, cameras] : shorthands) {
    if (views == name) return ToViewGrid(cameras);
  }
  ViewGrid grid;
  const std::vector<std::string> rows = Split(views, '/');
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::vector<std::string> cameras = Split(rows[row], ',');
    const int count = static_cast<int>(cameras.size());
    const bool is_last = row + 1 == rows.size();
    if (row == 0) grid.columns = std::max(count, 1);
    if (count == 0 || count > grid.columns || (count < grid.columns && !is_last)) {
      throw UsageError(
          fmt::format("--views={}: row {} has {} cameras, expected {}; only the last row may have "
                      "fewer",
                      views, row + 1, count, grid.columns));
    }
    grid.cameras.insert(grid.cameras.end(), cameras.begin(), cameras.end());
  }
  if (grid.cameras.size() > kMostViews) {
    throw UsageError(fmt::format("--views={}: {} views, expected at most {}", views,
                                 grid.cameras.size(), kMostViews));
  }
  return grid;
}

render::View ToView(const ViewOptions& options) {
  const auto [width, height] = ToSize("size", options.size);
  if (options.supersample != 1 && options.supersample != 2 && options.supersample != 4) {
    throw UsageError(fmt::format("--supersample={}: expected 1, 2 or 4", options.supersample));
  }
  render::View view;
  view.width = width;
  view.height = height;
  view.supersample = options.supersample;
  view.title = options.title;
  view.overlays = !options.no_overlays;
  view.parts = ToOverlayParts(options.overlay);
  view.look = ToLook(options);
  // Whoever names joints wants to see them.
  if (!options.plot.empty() && options.overlay.find("-plot") == std::string::npos) {
    view.parts.plot = true;
  }
  return view;
}

}  // namespace kinescope::app
