// `kinescope probe`: what is here, before one wonders why something does not work.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "render/renderer.h"
#include "render/video.h"
#include "server/app/commands.h"
#include "server/ros/bridge.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

json ProbeRenderer(const std::string& backend) {
  const auto start = std::chrono::steady_clock::now();
  try {
    const auto renderer = render::MakeRenderer(backend);
    renderer->Render(SceneState{}, render::NamedCamera("front", SceneState{}), render::View{});
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    return {{"works", true},
            {"renderer", renderer->renderer_string()},
            {"first_picture_secs", took.count()}};
  } catch (const render::RenderError& error) {
    return {{"works", false}, {"reason", error.what()}};
  }
}

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

int Probe(bool as_json) {
  json found;
  found["version"] = KINESCOPE_VERSION;
  found["backends"]["osmesa"] = ProbeRenderer("osmesa");
  for (const Encoder& each : kEncoders) found["encoders"][each.key] = ProbeEncoder(each);
  found["ros"] = {{"built", ros_bridge::BuiltWithRos()},
                  {"master_uri", ros_bridge::MasterUri()},
                  {"master_reachable", ros_bridge::MasterIsReachable()}};
  const bool can_draw = found["backends"]["osmesa"]["works"];
  if (as_json) {
    fmt::print("{}\n", found.dump(2));
    return can_draw ? 0 : 1;
  }
  const json& osmesa = found["backends"]["osmesa"];
  fmt::print("Kinescope {}\n", KINESCOPE_VERSION);
  if (can_draw) {
    fmt::print("osmesa   works: {}, first picture after {:.2f} s\n",
               osmesa["renderer"].get<std::string>(), osmesa["first_picture_secs"].get<double>());
  } else {
    fmt::print("osmesa   {}\n", osmesa["reason"].get<std::string>());
  }
  for (const Encoder& each : kEncoders) {
    const json& encoder = found["encoders"][each.key];
    fmt::print("{:<8} {}\n", each.name,
               encoder["works"] ? "works" : encoder["reason"].get<std::string>());
  }
  if (!found["ros"]["built"]) {
    fmt::print("ROS      not built in\n");
  } else {
    fmt::print("ROS      {} {}\n", found["ros"]["master_uri"].get<std::string>(),
               found["ros"]["master_reachable"] ? "answers" : "does not answer");
  }
  return can_draw ? 0 : 1;
}

}  // namespace

void AddProbe(CommandLine line) {
  CLI::App* command =
      line.app.add_subcommand("probe", "Which GL back-ends, encoders and ROS master are here");
  const auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "as JSON");
  int& exit_code = line.exit_code;
  command->callback([as_json, &exit_code] { exit_code = Probe(*as_json); });
}

}  // namespace kinescope::app
