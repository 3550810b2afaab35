#include "server/app/pipeline_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <vector>

#include "core/errors.h"
#include "server/app/figure_meshes.h"
#include "server/app/hand_tools.h"
#include "urdf/placed_mass.h"

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

// "head:1.5,t8:8@-0.15,0,0.1": at semicolons, and at commas that no number follows.
std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size() && !text.empty(); ++i) {
    const std::size_t next = std::min(text.find_first_not_of(' ', i + 1), text.size());
    const bool ends =
        i == text.size() || text[i] == ';' ||
        (text[i] == ',' &&
         (next == text.size() || std::isalpha(static_cast<unsigned char>(text[next])) != 0));
    if (!ends) continue;
    parts.push_back(text.substr(begin, i - begin));
    begin = next;
  }
  return parts;
}

loads::HandLoad ToHandLoad(const std::string& text) try {
  std::string list;
  for (const std::string& part : Split(text)) list += (list.empty() ? "" : ";") + part;
  return loads::ParseHandLoad(list);
} catch (const UsageError& error) {
  throw UsageError(fmt::format("--hand={}: {}", text, error.what()));
}

loads::LoadClassifier::Settings ToClasses(const std::string& text) try {
  constexpr double kMost = 5;  // of capacity; more is no limit
  const std::vector<double> up = urdf::ParseNumbers(text);
  const bool is_good = up.size() == 2 && up[0] > 0 && up[0] < up[1] && up[1] <= kMost;
  if (!is_good) throw std::invalid_argument("no two limits");
  return loads::LoadClassifier::WithLimits({up[0], up[1]});
} catch (const std::invalid_argument&) {
  throw UsageError(fmt::format(
      "--class_limits={}: expected two numbers, MEDIUM,HIGH, above 0 and rising, such as 0.3,0.6",
      text));
}

// Links, joints and TF frames have it in their names.
std::string ToModelName(const std::string& text) {
  const bool is_good = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (!is_good) {
    throw UsageError(fmt::format("--model_name={}: expected letters, digits and _", text));
  }
  return text;
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
  scene.tools = ReadHandTools(person.tool, convention);
}

}  // namespace

urdf::BodyDescription ToBody(const PersonOptions& person) {
  urdf::BodyDescription body;
  body.sex_is_assumed = !person.sex;
  if (person.sex) {
    body.sex = Choose<urdf::Sex>("sex", *person.sex,
                                 {{"male", urdf::Sex::kMale}, {"female", urdf::Sex::kFemale}});
  }
  body.mass_is_assumed = !person.mass;
  body.mass_kg = person.mass.value_or(body.sex == urdf::Sex::kMale ? 75 : 62);
  if (!urdf::FindDefect(body).empty()) {
    throw UsageError(fmt::format(
        "--mass={}: expected 20 to 300 kg; leave it out if it is not known", body.mass_kg));
  }
  try {
    body.table = urdf::ParseBodyTable(person.body_table);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--body_table={}: {}", person.body_table, error.what()));
  }
  try {
    for (const std::string& text : Split(person.extra_mass)) {
      body.extra_masses.push_back(urdf::ParseExtraMass(text));
    }
    if (auto defect = urdf::FindDefect(body); !defect.empty()) throw std::invalid_argument(defect);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--extra_mass={}: {}", person.extra_mass, error.what()));
  }
  return body;
}

loads::LoadSettings ToLoadSettings(const LoadOptions& loads) {
  using loads::Percentile;
  loads::LoadSettings settings;
  settings.strength.factor = loads.capacity_factor;
  if (!loads::FindDefect(settings.strength).empty()) {
    throw UsageError(fmt::format("--capacity_factor={}: expected 0.1 to 5", loads.capacity_factor));
  }
  settings.strength.percentile =
      Choose<Percentile>("capacity_percentile", loads.capacity_percentile,
                         {{"5", Percentile::k5}, {"50", Percentile::k50}, {"95", Percentile::k95}});
  settings.metric = Choose<LoadMetric>("load_metric", loads.load_metric,
                                       {{"total", LoadMetric::kTotal},
                                        {"overload", LoadMetric::kOverload},
                                        {"norm", LoadMetric::kNorm},
                                        {"external", LoadMetric::kExternal}});
  settings.motion.dynamic =
      Choose<bool>("load_mode", loads.load_mode, {{"dynamic", true}, {"static", false}});
  settings.classes = ToClasses(loads.class_limits);
  if (!loads.hand.empty()) settings.hands = ToHandLoad(loads.hand);
  settings.motion.cutoff_hz = loads.filter_hz;
  settings.compression_counts = ToSwitch("lumbar_compression", loads.lumbar_compression);
  if (auto defect = loads::FindDefect(settings); !defect.empty()) {
    throw UsageError(fmt::format("--filter_hz={}: {}", loads.filter_hz, defect));
  }
  return settings;
}

SceneOptions ToSceneOptions(const PersonOptions& person, double stale_secs,
                            const LoadOptions& loads) {
  SceneOptions scene;
  scene.model_name = ToModelName(person.model_name);
  scene.body = ToBody(person);
  scene.loads = ToLoadSettings(loads);
  if (person.height && !(*person.height >= 0.5 && *person.height <= 2.5)) {
    throw UsageError(fmt::format("--height={}: expected 0.5 to 2.5 m", *person.height));
  }
  scene.height_is_assumed = !person.height;
  scene.height_m = person.height.value_or(scene.height_m);
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
  ros_bridge::BridgeConfig config;
  config.reference_frame = options.reference_frame;
  config.tf = options.tf;
  config.joint_states = options.joint_states;
  config.external_scale = options.external_scale;
  return config;
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
