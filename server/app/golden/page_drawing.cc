#include "server/app/golden/page_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "core/picture_limits.h"
#include "core/system/check.h"
#include "core/system/json_text.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "render/image/plain_png.h"
#include "server/app/golden/page_browser.h"
#include "server/app/golden/page_script.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr int kMostNavigations = 20;
constexpr std::size_t kMostMessageBytes = 16 << 20;  // beside a picture

std::size_t MostPageBytes(const PageSpec& spec) {
  // A picture of noise, in base64.
  return kMostMessageBytes +
         6 * static_cast<std::size_t>(spec.width_px) * static_cast<std::size_t>(spec.height_px);
}

void CheckPageSpec(const PageSpec& spec) {
  const auto is_side = [](int px) { return px >= kMinPictureSide && px <= kMaxPictureSide; };
  if (!is_side(spec.width_px) || !is_side(spec.height_px)) {
    throw std::runtime_error(fmt::format("size {}x{}: expected {} to {} px on each side",
                                         spec.width_px, spec.height_px, kMinPictureSide,
                                         kMaxPictureSide));
  }
  for (const char* scheme : {"http://", "https://", "file://"}) {
    if (StartsWith(spec.url, scheme)) return;
  }
  throw std::runtime_error("expected an address that begins with http://, https:// or file://");
}

// An address for a message: without a password of a page, such as ours.
std::string ShownAddress(const std::string& url) {
  constexpr std::string_view kToken = "token=";
  std::string shown = PrintableLine(url);
  const std::size_t at = shown.find(kToken);
  if (at == std::string::npos) return shown;
  const std::size_t begin = at + kToken.size();
  return shown.replace(begin, shown.find_first_of("&#", begin) - begin, "...");
}

bool IsOfGoneDocument(const std::string& error) {
  for (const char* words : {"context", "navigated", "closed", "frame"}) {
    if (error.find(words) != std::string::npos) return true;
  }
  return false;
}

std::string ScriptCall(const char* function, const json& argument) {
  return fmt::format("({})({})", function, JsonText(argument, -1, JsonBytes::kAscii));
}

// One page in one browser.
class PageVisit {
 public:
  explicit PageVisit(const PageSpec& spec)
      : spec_(spec),
        browser_(spec.chromium.empty() ? FindChromium() : spec.chromium, MostPageBytes(spec),
                 spec.limit) {}

  PageDrawing Draw() {
    Open();
    Navigate();
    while (!BecomesReady()) {
    }
    browser_.SetStage("it to stand still");
    PageDrawing before = Look();
    while (true) {
      PageDrawing now = Look();
      const auto change = FindChange(before, now);
      if (!change) return now;
      browser_.SetStage(fmt::format(
          "it to stand still: {} changes; give what changes by itself the attribute data-changing",
          *change));
      before = std::move(now);
    }
  }

 private:
  void Open() {
    const json target = browser_.Call("Target.createTarget", {{"url", "about:blank"}});
    const json session = browser_.Call("Target.attachToTarget",
                                       {{"targetId", target.at("targetId")}, {"flatten", true}});
    browser_.UseSession(session.at("sessionId").get<std::string>(),
                        [this](const BrowserMessage& event) { OnEvent(event); });
    browser_.Call("Page.enable");
    browser_.Call("Inspector.enable");
    browser_.Call("Page.setLifecycleEventsEnabled", {{"enabled", true}});
    browser_.Call("Emulation.setFocusEmulationEnabled", {{"enabled", true}});
    browser_.Call("Emulation.setDeviceMetricsOverride", {{"width", spec_.width_px},
                                                         {"height", spec_.height_px},
                                                         {"deviceScaleFactor", 1},
                                                         {"mobile", false}});
    const json features = {
        {{"name", "prefers-reduced-motion"}, {"value", "reduce"}},
        {{"name", "prefers-color-scheme"}, {"value", spec_.is_dark ? "dark" : "light"}}};
    browser_.Call("Emulation.setEmulatedMedia", {{"features", features}});
    const json date = spec_.date_millis ? json(*spec_.date_millis) : json(nullptr);
    browser_.Call("Page.addScriptToEvaluateOnNewDocument",
                  {{"source", ScriptCall(kSteadyScript, date)}});
  }

  void Navigate() {
    browser_.SetStage("an answer from it");
    const json answer = browser_.Call("Page.navigate", {{"url", spec_.url}});
    if (answer.value("isDownload", false)) {
      throw std::runtime_error("is a download and no page");
    }
    const std::string error = PrintableLine(answer.value("errorText", ""));
    // Of an answer without a page, its status says more.
    if (error.empty() || error == "net::ERR_HTTP_RESPONSE_CODE_FAILURE") return;
    throw std::runtime_error("cannot be loaded: " + error);
  }

  void OnEvent(const BrowserMessage& event) {
    const json& content = event.content;
    if (event.method == "Inspector.targetCrashed") {
      throw std::runtime_error("has crashed its process of Chromium");
    }
    if (event.method == "Page.javascriptDialogOpening") {
      browser_.Post("Page.handleJavaScriptDialog", {{"accept", false}});
    } else if (event.method == "Page.frameNavigated") {
      OnNavigated(content.at("frame"));
    } else if (event.method == "Page.lifecycleEvent" && content.value("loaderId", "") == loader_) {
      const std::string name = content.value("name", "");
      is_loaded_ = is_loaded_ || name == "load";
      is_idle_ = is_idle_ || name == "networkAlmostIdle";
    }
  }

  void OnNavigated(const json& frame) {
    if (frame.contains("parentId")) return;
    frame_ = frame.at("id").get<std::string>();
    loader_ = frame.at("loaderId").get<std::string>();
    is_loaded_ = is_idle_ = false;
    address_ = ShownAddress(frame.value("url", ""));
    if (++navigations_ > kMostNavigations) {
      throw std::runtime_error("leads from address to address without end, last to " + address_);
    }
  }

  // False: it has gone to another address meanwhile.
  bool BecomesReady() {
    browser_.SetStage("it to be loaded");
    browser_.WaitUntil([this] { return is_loaded_ && is_idle_; });
    browser_.SetStage(
        spec_.ready_when.empty()
            ? "its fonts and pictures"
            : fmt::format("an element '{}', its fonts and pictures", spec_.ready_when));
    const std::optional<json> status = Run(ScriptCall(kReadyScript, spec_.ready_when));
    if (!status) return false;
    const int code = status->is_number_integer() ? status->get<int>() : 0;
    if (code >= 400) throw std::runtime_error(fmt::format("the server answers with {}", code));
    if (StartsWith(address_, "chrome-error:")) throw std::runtime_error("cannot be loaded");
    return true;
  }

  // The value that the script results in; nullopt: the page has gone to another address meanwhile.
  std::optional<json> Run(const std::string& script) {
    const int before = navigations_;
    json answer;
    try {
      const json world = browser_.Call("Page.createIsolatedWorld",
                                       {{"frameId", frame_}, {"worldName", "kinescope"}});
      answer = browser_.Call("Runtime.evaluate", {{"expression", script},
                                                  {"contextId", world.at("executionContextId")},
                                                  {"awaitPromise", true},
                                                  {"returnByValue", true}});
    } catch (const CallRefused& refused) {
      // The world was that of a document which is left: the next one is announced soon.
      if (navigations_ == before && !IsOfGoneDocument(refused.what())) throw;
      browser_.WaitUntil([&] { return navigations_ != before; });
      return std::nullopt;
    }
    if (navigations_ != before) return std::nullopt;
    if (!answer.contains("exceptionDetails")) return answer.at("result").value("value", json());
    const json& details = answer.at("exceptionDetails");
    const json exception = details.value("exception", json::object());
    const std::string description = exception.value("description", "no reason");
    throw std::runtime_error("cannot be read: " +
                             PrintableLine(description.substr(0, description.find('\n'))));
  }

  PageDrawing Look() {
    std::optional<json> seen;
    while (!(seen = Run(ScriptCall(kLookScript, json())))) {
      while (!BecomesReady()) {
      }
    }
    PageDrawing drawing;
    drawing.browser = browser_.version();
    drawing.elements = ElementsFrom(seen->at("elements"));
    drawing.content_height_px = seen->at("height").get<int>();
    drawing.image = Picture();
    return drawing;
  }

  render::Image Picture() {
    const json answer = browser_.Call("Page.captureScreenshot", {{"format", "png"}});
    const auto bytes = BytesFromBase64(answer.at("data").get_ref<const std::string&>());
    render::Image image;
    if (!render::ReadPlainPng(bytes.data(), bytes.size(), kMaxPictureSide, image)) {
      throw std::runtime_error("Chromium has made a picture that cannot be read");
    }
    if (image.width != spec_.width_px || image.height != spec_.height_px) {
      throw std::runtime_error(
          fmt::format("Chromium has made a picture of {}x{} px; expected {}x{}", image.width,
                      image.height, spec_.width_px, spec_.height_px));
    }
    return image;
  }

  const PageSpec& spec_;
  PageBrowser browser_;
  std::string frame_, loader_, address_;  // of the document that is shown
  bool is_loaded_ = false, is_idle_ = false;
  int navigations_ = 0;
};

struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;  // without the last
  bool Has(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
};

std::vector<PixelBox> ChangingBoxes(const PageDrawing& a, const PageDrawing& b) {
  std::vector<PixelBox> boxes;
  for (const PageDrawing* const drawing : {&a, &b}) {
    for (const PageElement& each : drawing->elements) {
      if (!each.is_changing) continue;
      boxes.push_back({static_cast<int>(std::floor(each.x_px)),
                       static_cast<int>(std::floor(each.y_px)),
                       static_cast<int>(std::ceil(each.x_px + each.width_px)),
                       static_cast<int>(std::ceil(each.y_px + each.height_px))});
    }
  }
  return boxes;
}

std::optional<std::string> FindPixelChange(const render::Image& a, const render::Image& b,
                                           const std::vector<PixelBox>& ignored) {
  if (a.width != b.width || a.height != b.height) return "the size of the picture";
  PixelBox box = {a.width, a.height, 0, 0};
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                                  static_cast<std::size_t>(x));
      if (std::equal(&a.rgba[at], &a.rgba[at] + 4, &b.rgba[at])) continue;
      if (std::any_of(ignored.begin(), ignored.end(),
                      [&](const PixelBox& each) { return each.Has(x, y); })) {
        continue;
      }
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
             std::max(box.bottom, y + 1)};
    }
  }
  if (box.right == 0) return std::nullopt;
  return fmt::format("{}x{} px at x {}, y {}", box.right - box.left, box.bottom - box.top, box.left,
                     box.top);
}

}  // namespace

std::optional<std::string> FindChange(const PageDrawing& a, const PageDrawing& b) {
  const auto texts_of = [](const PageDrawing& drawing) {
    std::vector<PageElement> still;
    for (const PageElement& each : drawing.elements) {
      if (!each.is_changing) still.push_back(each);
    }
    return still;
  };
  const std::vector<PageElement> before = texts_of(a), now = texts_of(b);
  const auto [one, other] = std::mismatch(before.begin(), before.end(), now.begin(), now.end());
  if (one != before.end() || other != now.end()) {
    const PageElement& changed = one != before.end() ? *one : *other;
    return fmt::format("'{}' ({})", changed.name, changed.text);
  }
  return FindPixelChange(a.image, b.image, ChangingBoxes(a, b));
}

PageDrawing DrawPage(const PageSpec& spec) {
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error(
        fmt::format("page: {}: {}", spec.name.empty() ? ShownAddress(spec.url) : spec.name, why));
  };
  try {
    CheckPageSpec(spec);
    return PageVisit(spec).Draw();
  } catch (const json::exception& error) {
    fail(std::string("Chromium has answered otherwise than expected: ") +
         PrintableLine(error.what()));
  } catch (const std::exception& error) {
    fail(error.what());
  }
  KINESCOPE_CHECK(false);
}

}  // namespace kinescope::app
