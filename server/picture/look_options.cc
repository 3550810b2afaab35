#include "server/picture/look_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "core/errors.h"
#include "server/options/choose.h"

namespace kinescope::app {
namespace {

void SetParts(const char* option, const std::string& names, bool shown, render::SceneLook& look) {
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto part =
        std::find_if(render::kSceneParts.begin(), render::kSceneParts.end(),
                     [&](const render::ScenePartInfo& info) { return name == info.name; });
    if (part == render::kSceneParts.end()) {
      throw UsageError(fmt::format("--{}={}: expected some of {},{}", option, name, PartNames(true),
                                   PartNames(false)));
    }
    look.shown.Set(part->part, shown);
  }
}

void SetBackground(const std::string& text, render::SceneLook& look) {
  if (text == "theme") return;
  if (text == "transparent") {
    look.is_transparent = true;
    return;
  }
  const std::string hex = text == "white" ? "#ffffff" : text == "black" ? "#000000" : text;
  const bool is_hex = hex.size() == 7 && hex[0] == '#' &&
                      hex.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!is_hex) {
    throw UsageError("--background=" + text +
                     ": expected theme, transparent, white, black or #RRGGBB");
  }
  const auto channel = [&](std::size_t at) {
    return std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0;
  };
  look.background = Rgb{channel(1), channel(3), channel(5)};
}

}  // namespace

render::SceneLook ToLook(const ViewOptions& options) {
  render::SceneLook look;
  if (options.theme != "light" && options.theme != "dark") {
    throw UsageError("--theme=" + options.theme + ": expected light or dark");
  }
  look.theme = options.theme == "dark" ? render::Theme::kDark : render::Theme::kLight;
  SetBackground(options.background, look);
  look.floor = ToSwitch("floor", options.floor);
  SetParts("show", options.show, true, look);
  SetParts("hide", options.hide, false, look);
  return look;
}

std::string PartNames(bool by_default) {
  std::string names;
  for (const render::ScenePartInfo& info : render::kSceneParts) {
    if (info.by_default != by_default) continue;
    names += names.empty() ? "" : ",";
    names += info.name;
  }
  return names;
}

}  // namespace kinescope::app
