#include "server/app/golden/page_browser.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/system/utf8.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr char kChromiumVariable[] = "KINESCOPE_CHROMIUM";

bool IsBrowserProgram(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

// Empty: not found.
fs::path FindBrowserInPath(const std::string& name) {
  const char* const variable = std::getenv("PATH");
  const std::string folders = variable == nullptr ? "/usr/bin" : variable;
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    fs::path path = fs::path(folders.substr(at, end - at)) / name;
    if (end > at && IsBrowserProgram(path)) return path;
    at = end + 1;
  }
  return {};
}

// The same pixels each time, on each machine that has the same fonts: no GPU, no subpixels of
// screens, corners that are drawn once and whole. Nothing on the network but the page.
constexpr const char* kChromiumFlags[] = {
    "--headless=new",
    "--remote-debugging-pipe",
    "--force-color-profile=srgb",
    "--force-device-scale-factor=1",
    "--hide-scrollbars",
    "--font-render-hinting=none",
    "--disable-lcd-text",
    "--disable-font-subpixel-positioning",
    "--disable-partial-raster",
    "--disable-skia-runtime-opts",
    "--disable-gpu",
    "--disable-gpu-rasterization",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-checker-imaging",
    "--disable-threaded-animation",
    "--disable-threaded-scrolling",
    "--blink-settings=imageAnimationPolicy=2",  // moving pictures stay at their first
    "--lang=en-US",
    "--accept-lang=en-US",
    "--mute-audio",
    "--no-first-run",
    "--no-default-browser-check",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-domain-reliability",
    "--disable-extensions",
    "--disable-sync",
    "--disable-breakpad",
    "--disable-crash-reporter",
    "--disable-dev-shm-usage",  // small in containers
    "--password-store=basic",
    "--use-mock-keychain",
};

// Settings of the user and of the machine's screen change nothing.
std::vector<std::string> BrowserEnvironment(const fs::path& folder) {
  return {"HOME=" + folder.string(),
          "XDG_CONFIG_HOME=" + (folder / "config").string(),
          "XDG_CACHE_HOME=" + (folder / "cache").string(),
          "XDG_DATA_HOME=" + (folder / "data").string(),
          "XDG_RUNTIME_DIR=" + folder.string(),
          "TMPDIR=" + folder.string(),
          "TZ=UTC",
          "LANG=C.UTF-8",
          "LANGUAGE",
          "LC_ALL=C.UTF-8",
          "DISPLAY",
          "WAYLAND_DISPLAY",
          "CHROMIUM_FLAGS",
          "DBUS_SESSION_BUS_ADDRESS=disabled:"};
}

bool IsOfUse(const std::string& line) {
  for (const char* noise : {"dbus", "unexpected operator", "gcm", "DEPRECATED_ENDPOINT"}) {
    if (line.find(noise) != std::string::npos) return false;
  }
  return line.find_first_not_of(" \t\r") != std::string::npos;
}

}  // namespace

fs::path FindChromium() {
  const char* const chosen = std::getenv(kChromiumVariable);
  if (chosen != nullptr && *chosen != '\0') {
    if (IsBrowserProgram(chosen)) return chosen;
    throw std::runtime_error(fmt::format("{}={}: is no program; set it to the path of Chromium",
                                         kChromiumVariable, chosen));
  }
  for (const char* name :
       {"chromium-headless-shell", "chromium", "chromium-browser", "google-chrome",
        "google-chrome-stable"}) {  // the first starts in a third of the time
    fs::path path = FindBrowserInPath(name);
    if (!path.empty()) return path;
  }
  throw std::runtime_error(fmt::format(
      "needs Chromium: install the package chromium-headless-shell or chromium, or set {} to its "
      "path",
      kChromiumVariable));
}

PageBrowser::PageBrowser(const fs::path& chromium, std::size_t most_bytes,
                         std::chrono::milliseconds limit)
    : limit_(limit),
      deadline_(Clock::now() + limit),
      process_({CommandOf(chromium), BrowserEnvironment(folder_.path()), "", /*has_channel=*/true}),
      messages_(most_bytes) {
  const json answer = Call("Browser.getVersion");
  const std::string product = answer.value("product", "");  // "Chrome/131.0.6778.85"
  version_ = "Chromium " + PrintableLine(product.substr(product.find('/') + 1));
}

std::vector<std::string> PageBrowser::CommandOf(const fs::path& chromium) const {
  std::vector<std::string> command = {chromium.string()};
  command.insert(command.end(), std::begin(kChromiumFlags), std::end(kChromiumFlags));
  command.push_back("--user-data-dir=" + (folder_ / "profile").string());
  // It refuses to run as root with its sandbox, as in containers.
  if (::geteuid() == 0) command.emplace_back("--no-sandbox");
  command.emplace_back("--no-startup-window");
  return command;
}

void PageBrowser::ThrowEnd() {
  std::string last;
  bool lacks_sandbox = false;
  const auto take_lines = [&] {
    while (const auto line = process_.TakeLine()) {
      if (IsOfUse(*line)) last = PrintableLine(*line);
      lacks_sandbox = lacks_sandbox || line->find("No usable sandbox") != std::string::npos;
    }
  };
  take_lines();
  const std::string ending = process_.End();
  take_lines();
  std::string why = "Chromium has ended with " + ending;
  if (!last.empty()) why += ": " + last;
  if (lacks_sandbox) {
    why += fmt::format(
        "; its sandbox needs user namespaces; in a container, set {} to a script that starts "
        "Chromium with --no-sandbox",
        kChromiumVariable);
  }
  throw std::runtime_error(why);
}

void PageBrowser::ReadMore() {
  if (!process_.has_channel()) ThrowEnd();
  if (!process_.Read(deadline_)) {
    throw std::runtime_error(fmt::format("is not ready after {} s: waited for {}",
                                         1e-3 * static_cast<double>(limit_.count()), stage_));
  }
  messages_.Add(process_.TakeReceived());
}

BrowserMessage PageBrowser::NextMessage() {
  while (true) {
    if (const auto text = messages_.Take()) return ParseBrowserMessage(*text);
    ReadMore();
  }
}

void PageBrowser::UseSession(std::string session, OnEvent on_event) {
  session_ = std::move(session);
  on_event_ = std::move(on_event);
}

void PageBrowser::TakeEvent(const BrowserMessage& message) const {
  if (!message.call && message.session == session_ && on_event_) on_event_(message);
}

std::int64_t PageBrowser::Send(const std::string& method, const json& parameters) {
  const std::int64_t number = ++calls_;
  if (process_.Send(CallText(number, method, parameters, session_), deadline_)) return number;
  // It has ended or does not read: which of the two, reading says.
  while (true) ReadMore();
}

void PageBrowser::Post(const std::string& method, const json& parameters) {
  Send(method, parameters);
}

json PageBrowser::Call(const std::string& method, const json& parameters) {
  const std::int64_t number = Send(method, parameters);
  while (true) {
    BrowserMessage message = NextMessage();
    TakeEvent(message);
    if (message.call != number) continue;
    if (message.error) throw CallRefused(*message.error);
    return std::move(message.content);
  }
}

void PageBrowser::WaitUntil(const std::function<bool()>& is_so) {
  while (!is_so()) TakeEvent(NextMessage());
}

}  // namespace kinescope::app
