/// The loads of chosen joints over time, gathered scene by scene for the plot strip.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene_state.h"
#include "render/load_history.h"

namespace kinescope::app {

/// Of the first person who has loads. One thread.
class LoadWindow {
 public:
  /// @param joints urdf::Joint, in the order shown
  explicit LoadWindow(std::vector<int> joints);

  bool is_empty() const { return joints_.empty(); }

  /// In order of time.
  void Add(const SceneState& state, double secs);

  /// All from 0 to the last one added.
  render::LoadHistory All() const;

  /// The `length_secs` that end at the last one added; what is older is forgotten.
  render::LoadHistory Last(double length_secs);

 private:
  std::vector<int> joints_;
  std::vector<render::LoadCurve> curves_;
  double last_secs_ = 0;
};

}  // namespace kinescope::app
