#include "server/scene/scene_options.h"

#include <fmt/format.h>

#include "core/system/check.h"
#include "core/system/errors.h"

namespace kinescope::app {
namespace {

using loads::Percentile;
using options::BadValue;

constexpr double kMaxClassLimit = 5;  // of capacity; more is no limit

}  // namespace

std::string FindDefect(const std::array<double, 2>& class_limits) {
  ClassLimitsValue value;
  const std::string text = fmt::format("{},{}", class_limits[0], class_limits[1]);
  try {
    value.Parse(text);
    return "";
  } catch (const BadValue&) {
    return "class limits " + text + ": expected " + value.Expected();
  }
}

ClassLimitsValue::ClassLimitsValue() : ValueOf(loads::LoadMeter::Settings().up) {}

void ClassLimitsValue::Parse(const std::string& text) {
  const auto up = options::ParseNumbers(text);
  const bool is_good =
      up && up->size() == 2 && (*up)[0] > 0 && (*up)[0] < (*up)[1] && (*up)[1] <= kMaxClassLimit;
  if (!is_good) RefuseText();
  value_ = {(*up)[0], (*up)[1]};
}

std::string ClassLimitsValue::ToText() const {
  return options::NumberText(value_[0]) + "," + options::NumberText(value_[1]);
}

std::string ClassLimitsValue::Expected() const {
  return fmt::format("MEDIUM,HIGH: two rising numbers above 0, at most {}, such as {},{}",
                     kMaxClassLimit, kDefaultClassLimits[0], kDefaultClassLimits[1]);
}

void HandLoadValue::Parse(const std::string& text) try {
  std::string items;
  for (const std::string& item : options::SplitItems(text)) {
    items += (items.empty() ? "" : ";") + item;
  }
  value_ = items.empty() ? HandLoad() : loads::ParseHandLoad(items);
  text_ = text;
} catch (const UsageError& error) {
  throw BadValue(error.what());
}

std::string HandLoadValue::Expected() const {
  return "right:KG, left:KG or both:KG, right:KG@X,Y,Z for another place than the grip (m, in the "
         "hand's link frame), with commas between several; or none";
}

LoadOptions::LoadOptions()
    : capacity_factor(loads::Strength().factor, {0.1, 5}),
      capacity_percentile({{"5", Percentile::k5}, {"50", Percentile::k50}, {"95", Percentile::k95}},
                          Percentile::k50),
      load_metric({{"total", LoadMetric::kTotal},
                   {"overload", LoadMetric::kOverload},
                   {"norm", LoadMetric::kNorm},
                   {"external", LoadMetric::kExternal}},
                  loads::LoadSettings().metric),
      load_mode({{"dynamic", true}, {"static", false}}, true),
      filter_hz(options::Number(loads::MotionFilter::Settings().cutoff_hz, {1, 30, "Hz"})),
      lumbar_compression(true),
      shown({{"held", false}, {"momentary", true}}, false),
      floor_z(options::Number(0, {-1000, 1000, "m"})) {}

void LoadOptions::List(options::OptionList& option) {
  option.Group("Joint loads");
  option("capacity_factor", capacity_factor, "this person's strength divided by the population's");
  option("capacity_percentile", capacity_percentile,
         "percentage of the population that is weaker than the reference strength");
  option("load_metric", load_metric,
         "load that is compared with the strength: total, overload (caused by the loads in the "
         "hands), "
         "norm (|moment|, without directions), external (received from another program)");
  option("load_mode", load_mode, "dynamic: with inertial forces; static: without");
  option("class_limits", class_limits,
         "shares of the capacity above which a rising load is medium (orange) and high (red)");
  option("hand_load", hand_load, "loads in the hands; none: known to be empty; not given: unknown");
  option.Formerly("hand");
  option(
      "filter_hz", filter_hz,
      "cut-off frequency of the low-pass filter of accelerations; not given: 10 Hz for recordings "
      "(without lag) and 5 Hz for streams");
  option("lumbar_compression", lumbar_compression,
         "on: L5/S1 shows the larger of moment and compression; off: the moment");
  option(
      "shown", shown,
      "ratio behind number, colour, size and order: held (rises at once, holds a peak for 0.3 s, "
      "then falls) or momentary (of each sample, for stills and fast motion)");
  option(
      "floor_z", floor_z,
      "height of the floor in the source's world; not given: the lowest level on which feet rest");
  measured.List(option);
}

options::Number StaleSecs() { return {SceneOptions().stale_secs, {0.05, 60, "s"}}; }

loads::LoadSettings ToLoadSettings(const LoadOptions& loads) {
  loads::LoadSettings settings;
  settings.strength.factor = *loads.capacity_factor;
  settings.strength.percentile = *loads.capacity_percentile;
  settings.metric = *loads.load_metric;
  settings.motion.dynamic = *loads.load_mode;
  settings.meter = loads::LoadMeter::WithLimits(*loads.class_limits);
  settings.meter.is_momentary = *loads.shown;
  settings.hands = *loads.hand_load;
  if (loads.filter_hz) {
    settings.motion.cutoff_hz = settings.motion.recording_cutoff_hz = *loads.filter_hz;
  }
  settings.compression_counts = *loads.lumbar_compression;
  KINESCOPE_CHECK(loads::FindDefect(settings).empty());
  return settings;
}

SceneOptions ToSceneOptions(const PersonOptions& person, const LoadOptions& loads,
                            double stale_secs) {
  SceneOptions scene;
  scene.model_name = *person.model_name;
  scene.body = ToBody(person);
  if (loads.floor_z) scene.floor_z = *loads.floor_z;
  scene.loads = ToLoadSettings(loads);
  scene.wrenches = ToWrenchSettings(loads.measured);
  scene.height_is_assumed = !person.height;
  scene.height_m = person.height.value_or(scene.height_m);
  scene.stale_secs = stale_secs;
  scene.bag.tf_topic = *person.tf_topic;
  scene.appearance = ToAppearance(person);
  scene.body_color = ToBodyColor(person);
  return scene;
}

SceneOptions ToShownSceneOptions(const PersonOptions& person, const LoadOptions& loads,
                                 double stale_secs) {
  SceneOptions scene = ToSceneOptions(person, loads, stale_secs);
  if (scene.appearance.has_meshes()) scene.mesh_cache = MeshCache::InMemory();
  return scene;
}

void UseMeshFiles(MeshCache::Lifetime lifetime, SceneOptions& scene) {
  if (scene.mesh_cache) scene.mesh_cache = MeshCache::OfUser(lifetime);
}

}  // namespace kinescope::app
