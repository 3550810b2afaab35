/// People and the loads in their joints, from options to the settings of the scene builder.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "server/body/person_options.h"
#include "server/loads/load_settings.h"
#include "server/options/option_list.h"
#include "server/scene/scene_builder.h"
#include "server/scene/wrench_options.h"

namespace kinescope::app {

/// MEDIUM,HIGH: ratios above which a rising load is medium, and high.
class ClassLimitsValue : public options::ValueOf<std::array<double, 2>> {
 public:
  ClassLimitsValue();

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
};

/// Why these are no such ratios: two rising numbers in the range of the option. "": they are.
[[nodiscard]] std::string FindDefect(const std::array<double, 2>& class_limits);

/// Loads in the hands; "" : unknown.
class HandLoadValue : public options::ValueOf<HandLoad> {
 public:
  HandLoadValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override { return {"none", "right", "left", "both"}; }

 private:
  std::string text_;
};

/// What joint loads are computed from, and compared with.
struct LoadOptions {
  LoadOptions();

  options::Number capacity_factor;
  options::Choice<loads::Percentile> capacity_percentile;
  options::Choice<LoadMetric> load_metric;
  options::Choice<bool> load_mode;  // true: dynamic
  ClassLimitsValue class_limits;
  HandLoadValue hand_load;
  options::Optional<options::Number> filter_hz;
  options::Switch lumbar_compression;
  options::Choice<bool> shown;  // true: momentary
  options::Optional<options::Number> floor_z;
  WrenchOptions measured;

  void List(options::OptionList& option);
};

/// Time without samples after which a stream is stale, s.
options::Number StaleSecs();

/// Reads the meshes of the person. @throws UsageError naming option, value and what was expected.
SceneOptions ToSceneOptions(const PersonOptions& person, const LoadOptions& loads = {},
                            double stale_secs = SceneOptions().stale_secs);
/// For commands that show the people: with their meshes, in memory.
SceneOptions ToShownSceneOptions(const PersonOptions& person, const LoadOptions& loads = {},
                                 double stale_secs = SceneOptions().stale_secs);
/// For commands that pass the URDF of the people on to other programs: its meshes may become files
/// of the user's cache. Without a folder for them the people consist of primitives.
void UseMeshFiles(MeshCache::Lifetime lifetime, SceneOptions& scene);
loads::LoadSettings ToLoadSettings(const LoadOptions& loads);

}  // namespace kinescope::app
