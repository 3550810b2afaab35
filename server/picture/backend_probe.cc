#include "server/picture/backend_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/system/json_parse.h"
#include "core/system/starts_with.h"
#include "render/renderer.h"
#include "server/picture/child_process.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMeasuring(250);

double SecsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

BackendReport FromJson(const json& reported) {
  BackendReport report;
  report.works = reported.at("works");
  report.reason = reported.value("reason", "");
  report.renderer = reported.value("renderer", "");
  report.gl_version = reported.value("gl_version", "");
  report.is_software = reported.value("software", false);
  report.first_picture_seconds = reported.value("first_picture_seconds", 0.0);
  report.pictures_per_second = reported.value("pictures_per_second", 0.0);
  report.log = reported.value("log", std::vector<std::string>());
  return report;
}

BackendReport Failed(std::string reason) {
  BackendReport report;
  report.reason = std::move(reason);
  return report;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (end > at) lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

json ToJson(const BackendReport& report) {
  if (!report.works) return {{"works", false}, {"reason", report.reason}, {"log", report.log}};
  return {{"works", true},
          {"renderer", report.renderer},
          {"gl_version", report.gl_version},
          {"software", report.is_software},
          {"first_picture_seconds", report.first_picture_seconds},
          {"pictures_per_second", report.pictures_per_second},
          {"log", report.log}};
}

BackendReport MeasureBackend(const std::string& backend) {
  BackendReport report;
  try {
    SceneOptions people;
    people.mesh_cache = MeshCache::InMemory();
    SceneReader reader("demo:lift", people);
    std::shared_ptr<const SceneState> scene = reader.Next();
    const render::Camera camera = render::NamedCamera("three_quarter", *scene);
    const auto start = Clock::now();
    const auto renderer =
        render::MakeRenderer(backend, [&](const std::string& line) { report.log.push_back(line); });
    render::Image image;
    renderer->RenderInto(image, *scene, camera, render::PictureSpec{});
    report.first_picture_seconds = SecsSince(start);
    const auto measured_from = Clock::now();
    int pictures = 0;
    do {  // every one of them differs from the one before
      scene = reader.Next();
      renderer->RenderInto(image, *scene, camera, render::PictureSpec{});
      ++pictures;
    } while (Clock::now() - measured_from < kMeasuring);
    report.pictures_per_second = pictures / SecsSince(measured_from);
    const render::RendererInfo info = renderer->info();
    report.renderer = info.renderer;
    report.gl_version = info.gl_version;
    report.is_software = info.is_software;
    report.works = true;
  } catch (const render::RenderError& error) {
    report.reason = error.what();
  }
  return report;
}

BackendReport ProbeBackend(const std::filesystem::path& program, const std::string& backend,
                           std::chrono::milliseconds limit) {
  ChildResult child;
  try {
    child = RunChild({program.string(), "probe", "--draw_with", backend}, limit);
  } catch (const std::exception& error) {
    return Failed(error.what());
  }
  if (child.was_too_slow) {
    return Failed(fmt::format("no picture within {} s; the driver hangs",
                              std::chrono::duration<double>(limit).count()));
  }
  if (child.signal != 0) {
    return Failed(fmt::format("the driver crashed ({}){}", ::strsignal(child.signal),
                              child.err.empty() ? "" : ": " + LastLineOf(child.err)));
  }
  const json reported = ParseJson(child.out);
  if (child.exit_code != 0 || !reported.is_object() || !reported.contains("works")) {
    return Failed(child.err.empty() ? "it exited without an error message" : LastLineOf(child.err));
  }
  BackendReport report = FromJson(reported);
  // What drivers write to stderr themselves.
  for (std::string& line : Lines(child.err)) report.log.push_back(std::move(line));
  return report;
}

std::vector<std::string> FindGpus(const std::filesystem::path& dev) {
  std::vector<std::string> found;
  const auto look = [&](const std::filesystem::path& folder, const std::string& prefix) {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::string name = entry.path().filename();
      if (name.size() > prefix.size() && StartsWith(name, prefix) &&
          std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), name.end(),
                      [](char c) { return c >= '0' && c <= '9'; })) {
        found.push_back(entry.path());
      }
    }
  };
  look(dev / "dri", "renderD");
  look(dev, "nvidia");
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace kinescope::app
