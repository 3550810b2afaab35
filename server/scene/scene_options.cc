#include "server/scene/scene_options.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "server/options/choose.h"
#include "urdf/placed_mass.h"

namespace kinescope::app {
namespace {

loads::HandLoad ToHandLoad(const std::string& text) try {
  std::string list;
  for (const std::string& part : SplitList(text)) list += (list.empty() ? "" : ";") + part;
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

}  // namespace

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
  FigureChoice figure = ToFigure(person);
  scene.smooth_figure = figure.is_smooth;
  scene.figure_meshes = std::move(figure.meshes);
  scene.tools = std::move(figure.tools);
  return scene;
}

}  // namespace kinescope::app
