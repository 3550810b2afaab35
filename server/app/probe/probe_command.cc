// `kinescope probe`: what is here, before one wonders why something does not work.
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/scratch_folder.h"
#include "render/renderer.h"
#include "render/video.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/picture/backend.h"
#include "server/picture/backend_probe.h"
#include "server/ros/bridge.h"

namespace kinescope::app {
namespace {

using Report = nlohmann::json;

struct Encoder {
  const char* name;
  const char* key;
  const char* file;
};
constexpr Encoder kEncoders[] = {{"H.264", "h264", "kinescope-probe.mp4"},
                                 {"VP9", "vp9", "kinescope-probe.webm"},
                                 {"WebP", "webp", "kinescope-probe.webp"},
                                 {"GIF", "gif", "kinescope-probe.gif"}};

Report ProbeEncoder(const Encoder& encoder) {
  try {  // never finished, so it leaves nothing behind
    render::VideoOptions options;
    options.alpha = false;  // known, so that the encoder is opened before the first picture
    render::MakeVideoWriter(TempFolderPath() / encoder.file, 64, 64, options);
    return {{"works", true}};
  } catch (const std::exception& error) {
    return {{"works", false}, {"reason", error.what()}};
  }
}

Report ProbeRos() {
  Report ros = {{"built", ros_bridge::BuiltWithRos()}, {"master_reachable", false}};
  try {
    ros["master_uri"] = ros_bridge::MasterUri();
    ros["master_reachable"] = ros_bridge::MasterIsReachable();
  } catch (const UsageError& error) {
    ros["master_uri"] = "";
    ros["reason"] = error.what();
  }
  return ros;
}

// Whether there is a GPU, and whether one of our back-ends reaches it.
Report Hardware(const Report& backends) {
  const std::vector<std::string> gpus = FindGpus();
  const Report& device = backends["egl_device"];
  std::string remark;
  if (device["works"]) {
    remark = "used by --backend egl_device or auto; the default, osmesa, renders in software";
  } else if (!gpus.empty()) {
    remark = "unused: " + device["reason"].get<std::string>();
  }
  return {{"devices", gpus}, {"usable", device["works"]}, {"remark", remark}};
}

void PrintReport(const Report& found) {
  Print("Kinescope {}\n", KINESCOPE_VERSION);
  for (const std::string& name : render::BackendNames()) {
    const Report& backend = found["backends"][name];
    if (!backend["works"]) {
      Print("{:<11}{}\n", name, backend["reason"].get<std::string>());
      continue;
    }
    Print("{:<11}works: {}, OpenGL {}, {:.0f} frames/s, first frame after {:.2f} s\n", name,
          backend["renderer"].get<std::string>(), backend["gl_version"].get<std::string>(),
          backend["pictures_per_second"].get<double>(),
          backend["first_picture_seconds"].get<double>());
  }
  const Report& hardware = found["hardware"];
  const auto devices = hardware["devices"].get<std::vector<std::string>>();
  const auto remark = hardware["remark"].get<std::string>();
  Print("GPU        {}{}{}\n",
        devices.empty() ? "none found" : fmt::format("{}", fmt::join(devices, ", ")),
        remark.empty() ? "" : "; ", remark);
  for (const Encoder& each : kEncoders) {
    const Report& encoder = found["encoders"][each.key];
    Print("{:<11}{}\n", each.name,
          encoder["works"] ? "works" : encoder["reason"].get<std::string>());
  }
  const Report& ros = found["ros"];
  if (!ros["built"]) {
    Print("ROS        not built in\n");
  } else if (ros.contains("reason")) {
    Print("ROS        {}\n", ros["reason"].get<std::string>());
  } else {
    Print("ROS        {} {}\n", ros["master_uri"].get<std::string>(),
          ros["master_reachable"] ? "is reachable" : "is not reachable");
  }
}

int Probe(bool as_json, double limit_secs) {
  const std::chrono::milliseconds limit(static_cast<long>(1000 * limit_secs));
  Report found;
  found["version"] = KINESCOPE_VERSION;
  bool can_draw = false;
  for (const std::string& name : render::BackendNames()) {  // in turn: they share the cores
    const BackendReport report = ProbeBackend(Machine().program, name, limit);
    can_draw = can_draw || report.works;
    found["backends"][name] = ToJson(report);
  }
  found["hardware"] = Hardware(found["backends"]);
  for (const Encoder& each : kEncoders) found["encoders"][each.key] = ProbeEncoder(each);
  found["ros"] = ProbeRos();
  if (as_json) {
    Print("{}\n", JsonText(found));
  } else {
    PrintReport(found);
  }
  return can_draw ? 0 : 1;
}

struct ProbeOptions {
  options::Flag json;
  options::Number limit_secs{std::chrono::duration<double>(kProbeLimit).count(),
                             {0, 3600, "s", true}};
  options::Text draw_with;  // started by ProbeBackend, in a process of its own

  void List(options::OptionList& option) {
    option("json", json, "print the result as JSON");
    option("limit_secs", limit_secs, "longest time that a back-end may take to start and draw");
    option.Group(options::kHidden);
    option("draw_with", draw_with, "used by probe itself");
  }
};

}  // namespace

Command ProbeCommand() {
  const auto values = std::make_shared<ProbeOptions>();
  Command command = CommandNamed("probe");
  values->List(command.options);
  command.footer = "Exit code: 0 a back-end works, 1 none works, 2 error.";
  command.run = [values](options::OptionList&) {
    if (values->draw_with->empty()) return Probe(*values->json, *values->limit_secs);
    Print("{}\n", JsonText(ToJson(MeasureBackend(*values->draw_with))));
    return 0;
  };
  return command;
}

}  // namespace kinescope::app
