/// From the ratio of a joint to its class over time: low-pass, hysteresis and dwell of
/// joint-loads.md 4.3. Runs on samples, not on drawn frames, so live view, clips and scrubbing
/// agree.
#pragma once

#include <array>
#include <cstdint>

#include "core/scene_state.h"

namespace kinescope::loads {

class LoadClassifier {
 public:
  /// Ratios and seconds. Index 0: between low and medium; 1: between medium and high.
  struct Settings {
    std::array<double, 2> up = {0.30, 0.60};
    std::array<double, 2> down = {0.25, 0.55};
    double low_pass_secs = 0.15;
    double dwell_up_secs = 0.2;
    double dwell_down_secs = 0.5;
  };

  /// Settings that rise at `up` and fall a twentieth of capacity lower (a sixth of the limit, where
  /// that is less), as the defaults do.
  [[nodiscard]] static Settings WithLimits(const std::array<double, 2>& up);

  LoadClassifier() = default;
  explicit LoadClassifier(const Settings& settings) : settings_(settings) {}

  /// From the next update on; the class stays what it is until then.
  void set_settings(const Settings& settings) { settings_ = settings; }

  /// `ratio` NaN: unknown, and the next valid one starts afresh, without hysteresis. So does a step
  /// of time backwards, or forward by more than 0.5 s.
  LoadClass Update(double ratio, std::int64_t stamp_nanos);

 private:
  void Restart(double ratio);

  Settings settings_;
  LoadClass class_ = LoadClass::kUnknown;
  double filtered_ = 0;
  std::int64_t last_nanos_ = 0;
  std::array<std::int64_t, 2> above_since_{};  // stamp, or kNotThere
  std::array<std::int64_t, 2> below_since_{};  // likewise
};

}  // namespace kinescope::loads
