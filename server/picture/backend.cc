#include "server/picture/backend.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "core/system/errors.h"
#include "render/once_log.h"
#include "server/picture/backend_probe.h"

namespace kinescope::app {
namespace {

std::chrono::milliseconds LimitOf(const BackendOptions& options) {
  return std::chrono::milliseconds(
      static_cast<std::chrono::milliseconds::rep>(std::ceil(1000 * *options.draw_limit_secs)));
}

// The first that works, best first.
BackendChoice ChooseByTrying(const std::vector<std::string>& gpus,
                             const std::filesystem::path& program) {
  std::string note;
  std::vector<std::string> candidates = {"osmesa", "egl"};
  // Nothing to try out where nothing is plugged in; most machines are such.
  if (!gpus.empty()) candidates.insert(candidates.begin(), "egl_device");
  for (const std::string& name : candidates) {
    // Without a GPU, what is fallen back to has nothing before it that could have failed.
    if (gpus.empty() && name == "osmesa" && render::HasBackend(name)) return {name, note};
    const BackendReport report = ProbeBackend(program, name, kProbeLimit);
    if (report.works) return {name, note};
    note += fmt::format("{}{} does not work: {}", note.empty() ? "" : "; ", name, report.reason);
  }
  throw render::RenderError("--backend=auto: " + note);
}

// Each renderer says once what is wrong with a mesh; all of this process together, too.
void WarnOnce(const std::string& line) {
  static const render::LogLine log = [](const std::string& text) { spdlog::warn("{}", text); };
  static std::mutex mutex;
  static render::OnceLog once(log);  // guarded by mutex
  const std::lock_guard<std::mutex> lock(mutex);
  once(line);
}

options::Choice<std::string>::Words BackendWords() {
  options::Choice<std::string>::Words words;
  for (const std::string& name : render::BackendNames()) words.emplace_back(name, name);
  words.emplace_back("auto", "auto");
  return words;
}

}  // namespace

BackendOptions::BackendOptions()
    : backend(BackendWords(), "osmesa"), draw_limit_secs(0, {0, 1e6, "s"}) {}

void BackendOptions::List(options::OptionList& option) {
  option(
      "backend", backend,
      "OpenGL implementation: osmesa and egl (software), egl_device (a GPU), auto (a GPU where one "
      "works, else software)");
  option(
      "draw_limit_secs", draw_limit_secs,
      "time for one picture after which the graphics driver counts as hung; 0: 30 s plus 1 s per "
      "million pixels");
}

BackendChoice ChooseBackend(const BackendOptions& options, const Machine& machine) {
  const std::vector<std::string> gpus = FindGpus(machine.dev);
  if (*options.backend == "auto") {
    BackendChoice choice = ChooseByTrying(gpus, machine.program);
    if (!choice.note.empty())
      choice.note = "rendered by " + choice.name + ", because " + choice.note;
    return choice;
  }
  std::string note;
  if (*options.backend != "egl_device" && !gpus.empty()) {
    note = fmt::format(
        "software rendering, although a GPU is present ({}); use --backend auto or egl_device",
        fmt::join(gpus, ", "));
  }
  return {*options.backend, note};
}

std::unique_ptr<render::Renderer> StartRenderer(const BackendOptions& options,
                                                const BackendChoice& choice,
                                                std::function<void(const std::string&)> on_hang) {
  render::RendererSettings settings;
  settings.backend = choice.name;
  settings.note = choice.note;
  settings.log = WarnOnce;
  settings.limit = LimitOf(options);
  settings.on_hang = std::move(on_hang);
  return render::MakeRenderer(std::move(settings));
}

std::unique_ptr<render::Renderer> StartRenderer(const BackendOptions& options) {
  return RenderersOf(options)(nullptr);
}

RendererFactory RenderersOf(const BackendOptions& options) {
  const BackendChoice choice = ChooseBackend(options);
  if (!choice.note.empty()) spdlog::warn("pictures: {}", choice.note);
  return [options, choice](std::function<void(const std::string&)> on_hang) {
    return StartRenderer(options, choice, std::move(on_hang));
  };
}

std::map<std::string, std::string> DrawnBy(const render::Renderer& renderer) {
  const render::RendererInfo info = renderer.info();
  std::map<std::string, std::string> said = {{"Renderer", info.renderer},
                                             {"Backend", info.backend}};
  if (!info.note.empty()) said["Backend note"] = info.note;
  return said;
}

}  // namespace kinescope::app
