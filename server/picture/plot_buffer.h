/// Collects the loads of chosen joints over time, scene by scene, for the plot strip.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene_state.h"
#include "render/load_curves.h"

namespace kinescope::app {

/// Loads of the first person who has any. One thread.
class PlotBuffer {
 public:
  /// @param joints urdf::Joint, in display order
  explicit PlotBuffer(std::vector<int> joints);

  bool is_empty() const { return joints_.empty(); }

  /// Call it in order of time. `secs`: time of the state in the clip.
  void Add(const SceneState& state, double secs);

  /// All from 0 to the last one added.
  render::LoadCurves All() const;

  /// The `length_secs` up to the last one added; older values are discarded.
  render::LoadCurves Last(double length_secs);

 private:
  std::vector<int> joints_;
  std::vector<render::LoadCurve> curves_;
  double last_secs_ = 0;
};

}  // namespace kinescope::app
