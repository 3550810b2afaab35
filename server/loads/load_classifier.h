/// Computes the load class of a joint over time from its ratio: low-pass, hysteresis and dwell of
/// joint-loads.md 4.3. It runs on samples, not on rendered frames, so live view, clips and
/// scrubbing agree. One thread.
#pragma once

#include <array>
#include <cstdint>

#include "core/load_class.h"

namespace kinescope::loads {

class LoadClassifier {
 public:
  /// Limits are ratios, times are seconds. Index 0: between low and medium; 1: between medium and
  /// high.
  struct Settings {
    std::array<double, 2> up = kDefaultClassLimits;
    std::array<double, 2> down = {0.25, 0.55};
    double low_pass_secs = 0.15;
    double dwell_up_secs = 0.2;
    double dwell_down_secs = 0.5;
  };

  /// Settings with rising limits `up`. The falling limits are lower by 0.05 (by a sixth of the
  /// limit where that is less), as in the defaults.
  [[nodiscard]] static Settings WithLimits(const std::array<double, 2>& up);

  LoadClassifier() = default;
  explicit LoadClassifier(const Settings& settings) : settings_(settings) {}

  /// Valid from the next update on; the class does not change until then.
  void set_settings(const Settings& settings) { settings_ = settings; }

  /// `ratio` NaN: unknown, and the next valid ratio starts over without hysteresis. A step back in
  /// time, or forward by more than 0.5 s, starts over, too.
  LoadClass Update(double ratio, std::int64_t stamp_nanos);

 private:
  void Restart(double ratio);

  Settings settings_;
  LoadClass class_ = LoadClass::kUnknown;
  double filtered_ = 0;
  std::int64_t last_nanos_ = 0;
  std::array<std::int64_t, 2> above_since_{};  // stamp in ns, or kNotThere
  std::array<std::int64_t, 2> below_since_{};  // stamp in ns, or kNotThere
};

}  // namespace kinescope::loads
