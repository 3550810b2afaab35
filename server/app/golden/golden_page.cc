#include "server/app/golden/golden_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "core/system/errors.h"
#include "core/system/sha256.h"
#include "core/system/starts_with.h"
#include "render/font.h"
#include "server/app/golden/dashboard_drawing.h"
#include "server/app/golden/page_drawing.h"
#include "server/app/html.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

bool IsAddress(const std::string& page) {
  constexpr std::array<const char*, 3> kSchemes = {"http://", "https://", "file://"};
  return std::any_of(kSchemes.begin(), kSchemes.end(),
                     [&](const char* scheme) { return StartsWith(page, scheme); });
}

// The keys of the person and of the loads, which `serve` has, too.
std::vector<std::string> ServeOptionsOf(const GoldenCase& golden_case) {
  GoldenCase copy = golden_case;  // a list refers to values that can be set
  options::OptionList list;
  copy.person.List(list);
  copy.loads.List(list);
  std::vector<std::string> options;
  for (options::Option& option : list) {
    if (golden_case.given.count(option.name) == 0) continue;
    option.value->SetFolder(fs::current_path());  // the server runs in another folder
    for (const std::string& text : option.value->ToTexts()) {
      options.push_back(fmt::format("--{}={}", option.name, text));
    }
  }
  return options;
}

std::set<std::string> KeysOf(bool is_dashboard) {
  std::set<std::string> keys = {"page", "size", "theme", "mask", "tolerance"};
  if (!is_dashboard) return keys;
  keys.insert({"source", "time"});
  GoldenCase all;
  options::OptionList list;
  all.person.List(list);
  all.loads.List(list);
  for (const options::Option& option : list) keys.insert(option.name);
  return keys;
}

PageDrawing DrawnPage(const GoldenCase& golden_case) {
  const std::string& page = *golden_case.page;
  const options::PixelSize size = *golden_case.view.size;
  const bool is_dark = *golden_case.view.theme == render::Theme::kDark;
  if (!IsDashboard(page)) {
    PageSpec spec;
    spec.url = page;
    spec.width_px = size.width;
    spec.height_px = size.height;
    spec.is_dark = is_dark;
    return DrawPage(spec);
  }
  DashboardSpec spec;
  spec.source = *golden_case.source;
  spec.time = *golden_case.time;
  spec.query = page.substr(std::min(page.size(), sizeof kDashboard));
  spec.options = ServeOptionsOf(golden_case);
  spec.width_px = size.width;
  spec.height_px = size.height;
  spec.is_dark = is_dark;
  return DrawDashboard(spec);
}

render::Tile BoxOf(const PageElement& element, const render::Image& image) {
  const int left = std::max(0, static_cast<int>(std::floor(element.x_px))),
            top = std::max(0, static_cast<int>(std::floor(element.y_px)));
  return render::Intersection(
      {left, top, static_cast<int>(std::ceil(element.x_px + element.width_px)) - left,
       static_cast<int>(std::ceil(element.y_px + element.height_px)) - top},
      {0, 0, image.width, image.height});
}

// Words are compared as those of a picture, by the names of their elements; what has none is an
// object with a place and a size.
void AddTo(PictureFacts& facts, const PageElement& element) {
  const double x = element.x_px + element.width_px / 2, y = element.y_px + element.height_px / 2;
  if (!element.text.empty()) {
    facts.texts.push_back({element.name, element.text, x, y});
    return;
  }
  ObjectFact object;
  object.name = fmt::format("{} ({})", element.name, element.role);
  object.pixels = std::llround(element.width_px * element.height_px);
  object.x_px = x;
  object.y_px = y;
  facts.objects.push_back(std::move(object));
}

}  // namespace

bool IsDashboard(const std::string& page) {
  return page == kDashboard || StartsWith(page, std::string(kDashboard) + "?");
}

bool IsPageFile(const std::string& page) { return !IsDashboard(page) && !IsAddress(page); }

void ResolvePage(GoldenCase& golden_case, const fs::path& yaml) {
  const std::string page = *golden_case.page;
  const bool is_dashboard = IsDashboard(page);
  const std::set<std::string> keys = KeysOf(is_dashboard);
  for (const auto& [key, ignored] : golden_case.given) {
    if (keys.count(key) > 0) continue;
    throw UsageError(fmt::format("{}: {}: has no effect on {}; leave it out", yaml.string(), key,
                                 is_dashboard ? "the dashboard" : "a web page"));
  }
  if (is_dashboard && golden_case.source->empty()) {
    throw UsageError(yaml.string() + ": source is missing: the recording that the dashboard shows");
  }
  if (!IsPageFile(page)) return;
  const fs::path file = fs::absolute(yaml.parent_path() / page).lexically_normal();
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw UsageError(
        fmt::format("{}: page={}: there is no such file; expected a file, relative to the case, an "
                    "address (http://, https:// or file://), or {} with a source",
                    yaml.string(), page, kDashboard));
  }
  golden_case.page_file = file;
  golden_case.page = "file://" + PercentEncoded(file.string());
}

GoldenDrawing DrawPageOf(const GoldenCase& golden_case) {
  PageDrawing page = DrawnPage(golden_case);
  GoldenDrawing drawing;
  drawing.environment = {{"browser", page.browser},
                         {"font", DigestOf(render::FontPath("DejaVuSans.ttf")).sha256}};
  drawing.facts.has_floor = false;
  for (const PageElement& element : page.elements) {
    if (!element.is_changing) {
      AddTo(drawing.facts, element);
      continue;
    }
    const render::Tile box = BoxOf(element, page.image);
    if (!render::IsEmpty(box)) drawing.masks.push_back({box, element.name + " changes by itself"});
  }
  drawing.image = std::move(page.image);
  return drawing;
}

}  // namespace kinescope::app
