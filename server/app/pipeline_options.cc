#include "server/app/pipeline_options.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "server/app/figure_meshes.h"
#include "server/core/errors.h"

namespace kinescope::app {
namespace {

template <class Value>
using Choices = std::vector<std::pair<const char*, Value>>;

template <class Value>
Value Choose(const char* name, const std::string& given, const Choices<Value>& choices) {
  std::string known;
  for (const auto& [text, value] : choices) {
    if (given == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw UsageError(fmt::format("--{}={}: expected one of {}", name, given, known));
}

void SetFigure(const PersonOptions& person, SceneOptions& scene) {
  using Frame = urdf::MeshConvention::Frame;
  urdf::MeshConvention convention;
  convention.metres_per_unit =
      Choose<double>("mesh_units", person.mesh_units, {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}});
  convention.y_is_up = Choose<bool>("mesh_up", person.mesh_up, {{"z", false}, {"y", true}});
  convention.fits_person =
      Choose<bool>("mesh_scale", person.mesh_scale, {{"fit", true}, {"none", false}});
  convention.frame = Choose<Frame>(
      "mesh_frame", person.mesh_frame,
      {{"auto", Frame::kLonger}, {"segment", Frame::kSegment}, {"link", Frame::kLink}});

  const std::string meshes = "mesh:";
  if (person.figure.rfind(meshes, 0) == 0 && person.figure.size() > meshes.size()) {
    scene.figure_meshes = ReadFigureMeshes(person.figure.substr(meshes.size()), convention);
  } else if (person.figure != "smooth" && person.figure != "primitive") {
    throw UsageError(
        fmt::format("--figure={}: expected smooth, primitive or mesh:FOLDER", person.figure));
  }
  scene.smooth_figure = person.figure != "primitive";
}

}  // namespace

SceneOptions ToSceneOptions(const PersonOptions& person, double stale_secs) {
  SceneOptions scene;
  scene.model_name = person.model_name;
  if (person.sex != "male" && person.sex != "female") {
    throw UsageError(fmt::format("--sex={}: expected male or female", person.sex));
  }
  scene.body.sex = urdf::ParseSex(person.sex);
  scene.body.mass_is_assumed = person.mass == 0;
  if (scene.body.mass_is_assumed) {
    scene.body.mass_kg = scene.body.sex == urdf::Sex::kMale ? 75 : 62;
  } else {
    if (!(person.mass >= 20 && person.mass <= 300)) {
      throw UsageError(fmt::format("--mass={}: expected 20 to 300 kg", person.mass));
    }
    scene.body.mass_kg = person.mass;
  }
  if (!(person.height >= 0.5 && person.height <= 2.5)) {
    throw UsageError(fmt::format("--height={}: expected 0.5 to 2.5 m", person.height));
  }
  scene.height_m = person.height;
  if (!(stale_secs >= 0.05 && stale_secs <= 60)) {
    throw UsageError(fmt::format("--stale_secs={}: expected 0.05 to 60 s", stale_secs));
  }
  scene.stale_secs = stale_secs;
  SetFigure(person, scene);
  return scene;
}

ros_bridge::BridgeConfig ToBridgeConfig(const ServeOptions& options) {
  if (options.tf != "flat" && options.tf != "tree" && options.tf != "off") {
    throw UsageError(fmt::format("--tf={}: expected flat, tree or off", options.tf));
  }
  if (options.joint_states != "computed" && options.joint_states != "streamed") {
    throw UsageError(
        fmt::format("--joint_states={}: expected computed or streamed", options.joint_states));
  }
  return {options.reference_frame, options.tf, options.joint_states, ""};
}

ros_bridge::RosMode ToRosMode(const std::string& ros) {
  if (ros == "off") return ros_bridge::RosMode::kOff;
  if (ros == "auto") return ros_bridge::RosMode::kAuto;
  if (ros == "required") return ros_bridge::RosMode::kRequired;
  throw UsageError(fmt::format("--ros={}: expected auto, off or required", ros));
}

mvn::Stamps ToStamps(const std::string& stamps) {
  if (stamps == "fitted") return mvn::Stamps::kFitted;
  if (stamps == "arrival") return mvn::Stamps::kArrival;
  throw UsageError(fmt::format("--stamps={}: expected fitted or arrival", stamps));
}

bool ToSwitch(const std::string& name, const std::string& on_or_off) {
  if (on_or_off == "on") return true;
  if (on_or_off == "off") return false;
  throw UsageError(fmt::format("--{}={}: expected on or off", name, on_or_off));
}

std::pair<int, int> ToSize(const std::string& name, const std::string& text) {
  int width = 0;
  int height = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool has_x = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = has_x ? std::from_chars(first.ptr + 1, end, height) : first;
  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 8192; };
  if (!has_x || second.ec != std::errc() || second.ptr != end || !fits(width) || !fits(height)) {
    throw UsageError(fmt::format(
        "--{}={}: expected WIDTHxHEIGHT, each 16 to 8192, such as 1280x720", name, text));
  }
  return {width, height};
}

}  // namespace kinescope::app
