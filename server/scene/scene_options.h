/// People and the loads in their joints, from options to what the scene builder takes.
#pragma once

#include <string>

#include "server/body/person_options.h"
#include "server/loads/load_settings.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

/// What the loads in the joints are computed from, and what they are measured against.
struct LoadOptions {
  double capacity_factor = loads::Strength().factor;
  std::string capacity_percentile = "50";
  std::string load_metric = Name(loads::LoadSettings().metric);
  std::string load_mode = "dynamic";
  std::string class_limits = "0.3,0.6";
  std::string hand;
  double filter_hz = loads::MotionFilter::Settings().cutoff_hz;
  std::string lumbar_compression = "on";

  template <class Option>
  void Visit(Option&& option) {
    option("capacity_factor", capacity_factor,
           "this person's strength over that of the population, 0.1 to 5");
    option("capacity_percentile", capacity_percentile,
           "strength of the population to measure against: 5, 50 or 95 percent are weaker");
    option("load_metric", load_metric,
           "total, overload (what the load in the hands adds), norm (|moment|, without directions) "
           "or external (as another program computed it)");
    option("load_mode", load_mode, "dynamic (accelerations take part) or static");
    option("class_limits", class_limits,
           "of capacity: above the first a load is medium (orange), above the second high (red), "
           "while it rises");
    option("hand", hand,
           "what the hands hold: right:KG, left:KG or both:KG, right:KG@X,Y,Z (m, in the hand's "
           "link frame) for another place than the grip, several with commas between; none: "
           "nothing, for certain; not given: not known");
    option("filter_hz", filter_hz, "cut-off of the low-pass for accelerations, 3 to 10 Hz");
    option("lumbar_compression", lumbar_compression,
           "on or off: L5/S1 shows the worse of its moment and its compression");
  }
};

// Both: @throws UsageError naming option, value and what was expected.
SceneOptions ToSceneOptions(const PersonOptions& person, double stale_secs,
                            const LoadOptions& loads = {});
loads::LoadSettings ToLoadSettings(const LoadOptions& loads);

}  // namespace kinescope::app
