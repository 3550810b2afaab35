// `kinescope probe`: what is here, before one wonders why something does not work.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/json_text.h"
#include "render/renderer.h"
#include "render/video.h"
#include "server/app/commands.h"
#include "server/picture/backend.h"
#include "server/picture/backend_probe.h"
#include "server/ros/bridge.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

struct Encoder {
  const char* name;
  const char* key;
  const char* file;
};
constexpr Encoder kEncoders[] = {{"H.264", "h264", "kinescope-probe.mp4"},
                                 {"VP9", "vp9", "kinescope-probe.webm"},
                                 {"WebP", "webp", "kinescope-probe.webp"},
                                 {"GIF", "gif", "kinescope-probe.gif"}};

json ProbeEncoder(const Encoder& encoder) {
  try {  // never finished, so it leaves nothing behind
    render::VideoOptions options;
    options.alpha = false;  // known, so that the encoder is opened before the first picture
    render::MakeVideoWriter(std::filesystem::temp_directory_path() / encoder.file, 64, 64, options);
    return {{"works", true}};
  } catch (const std::exception& error) {
    return {{"works", false}, {"reason", error.what()}};
  }
}

// Whether there is a GPU, and whether one of our back-ends reaches it.
json Hardware(const json& backends) {
  const std::vector<std::string> gpus = FindGpus();
  const json& device = backends["egl_device"];
  std::string remark;
  if (device["works"]) {
    remark = "used by --backend egl_device or auto; the default, osmesa, draws in software";
  } else if (!gpus.empty()) {
    remark = "unused: " + device["reason"].get<std::string>();
  }
  return {{"devices", gpus}, {"usable", device["works"]}, {"remark", remark}};
}

void PrintText(const json& found) {
  fmt::print("Kinescope {}\n", KINESCOPE_VERSION);
  for (const std::string& name : render::BackendNames()) {
    const json& backend = found["backends"][name];
    if (!backend["works"]) {
      fmt::print("{:<11}{}\n", name, backend["reason"].get<std::string>());
      continue;
    }
    fmt::print("{:<11}works: {}, OpenGL {}, {:.0f} pictures/s, the first after {:.2f} s\n", name,
               backend["renderer"].get<std::string>(), backend["gl_version"].get<std::string>(),
               backend["pictures_per_second"].get<double>(),
               backend["first_picture_secs"].get<double>());
  }
  const json& hardware = found["hardware"];
  const auto devices = hardware["devices"].get<std::vector<std::string>>();
  const auto remark = hardware["remark"].get<std::string>();
  fmt::print("GPU        {}{}{}\n",
             devices.empty() ? "none seen" : fmt::format("{}", fmt::join(devices, ", ")),
             remark.empty() ? "" : "; ", remark);
  for (const Encoder& each : kEncoders) {
    const json& encoder = found["encoders"][each.key];
    fmt::print("{:<11}{}\n", each.name,
               encoder["works"] ? "works" : encoder["reason"].get<std::string>());
  }
  const json& ros = found["ros"];
  if (!ros["built"]) {
    fmt::print("ROS        not built in\n");
  } else {
    fmt::print("ROS        {} {}\n", ros["master_uri"].get<std::string>(),
               ros["master_reachable"] ? "answers" : "does not answer");
  }
}

int Probe(bool as_json, double limit_secs) {
  if (!(limit_secs > 0 && limit_secs <= 3600)) {
    throw UsageError(fmt::format("--limit_secs={}: expected up to 3600", limit_secs));
  }
  const std::chrono::milliseconds limit(static_cast<long>(1000 * limit_secs));
  json found;
  found["version"] = KINESCOPE_VERSION;
  bool can_draw = false;
  for (const std::string& name : render::BackendNames()) {  // in turn: they share the cores
    const BackendReport report = ProbeBackend(Machine().program, name, limit);
    can_draw = can_draw || report.works;
    found["backends"][name] = ToJson(report);
  }
  found["hardware"] = Hardware(found["backends"]);
  for (const Encoder& each : kEncoders) found["encoders"][each.key] = ProbeEncoder(each);
  found["ros"] = {{"built", ros_bridge::BuiltWithRos()},
                  {"master_uri", ros_bridge::MasterUri()},
                  {"master_reachable", ros_bridge::MasterIsReachable()}};
  if (as_json) {
    fmt::print("{}\n", JsonText(found, 2));
  } else {
    PrintText(found);
  }
  return can_draw ? 0 : 1;
}

}  // namespace

void AddProbe(CommandLine line) {
  CLI::App* command =
      line.app.add_subcommand("probe", "Which GL back-ends, encoders and ROS master are here");
  const auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "as JSON");
  const auto draw_with = std::make_shared<std::string>();
  const auto limit_secs =
      std::make_shared<double>(std::chrono::duration<double>(kProbeLimit).count());
  command
      ->add_option("--limit_secs", *limit_secs,
                   "so long may a back-end take for its start and some pictures")
      ->capture_default_str();
  // What ProbeBackend starts, for which there is a process of its own.
  command->add_option("--draw_with", *draw_with)->group("");
  int& exit_code = line.exit_code;
  command->callback([=, &exit_code] {
    if (draw_with->empty()) {
      exit_code = Probe(*as_json, *limit_secs);
    } else {
      fmt::print("{}\n", JsonText(ToJson(MeasureBackend(*draw_with))));
    }
  });
}

}  // namespace kinescope::app
