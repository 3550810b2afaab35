/// The load that people see: from the momentary ratio of a joint, one shown ratio, and its class.
/// Number, colour, size and order of every sink come from it, so that they cannot contradict each
/// other. It reads like the level meter of a sound recorder: it rises at once, holds a peak, then
/// falls. It runs on samples, not on rendered frames, so live view, clips and scrubbing agree. One
/// thread.
#pragma once

#include <array>
#include <cstdint>

#include "core/load_class.h"

namespace kinescope::loads {

class LoadMeter {
 public:
  /// Limits are ratios, times are seconds. Index 0: between low and medium; 1: between medium and
  /// high.
  struct Settings {
    std::array<double, 2> up = kDefaultClassLimits;
    std::array<double, 2> down = kDefaultClassFallsBelow;
    bool is_momentary = false;  // shows each sample as it is: no times, no hysteresis
    double rise_secs = 0.03;    // time constant
    double hold_secs = 0.3;
    double fall_secs = 0.3;  // time constant
  };

  struct Reading {
    double ratio = 0;  // NaN: unknown
    /// That of `ratio`, with hysteresis: above the upper limit of its class never, below the lower
    /// one by at most up - down.
    LoadClass load_class = LoadClass::kUnknown;
  };

  /// Settings with rising limits `up`. The falling limits are lower by 0.05 (by a sixth of the
  /// limit where that is less), as in the defaults.
  [[nodiscard]] static Settings WithLimits(const std::array<double, 2>& up);

  LoadMeter() = default;
  explicit LoadMeter(const Settings& settings) : settings_(settings) {}

  /// Valid from the next update on; the reading does not change until then.
  void set_settings(const Settings& settings) { settings_ = settings; }

  /// `ratio` NaN: unknown, and the next valid ratio starts over without hysteresis. A step back in
  /// time, or forward by more than 0.5 s, starts over, too.
  Reading Update(double ratio, std::int64_t stamp_nanos);

 private:
  Settings settings_;
  Reading reading_;
  std::int64_t last_nanos_ = 0;
  std::int64_t peak_nanos_ = 0;  // when the ratio last was not below the reading
};

/// The class of a ratio alone, without hysteresis: above a limit is the higher class. NaN: unknown.
LoadClass BandOf(double ratio, const std::array<double, 2>& limits);

}  // namespace kinescope::loads
