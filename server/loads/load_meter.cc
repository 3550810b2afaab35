#include "server/loads/load_meter.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"
#include "server/loads/gap.h"

namespace kinescope::loads {
namespace {

// Share of a difference that is left after `secs`.
double Left(double secs, double time_constant) {
  return time_constant > 0 ? std::exp(-secs / time_constant) : 0.0;
}

}  // namespace

LoadMeter::Settings LoadMeter::WithLimits(const std::array<double, 2>& up) {
  constexpr double kGap = 0.05, kGapOfLimit = 1.0 / 6;
  Settings settings;
  settings.up = up;
  for (std::size_t i = 0; i < up.size(); ++i) {
    settings.down[i] = up[i] - std::min(kGap, kGapOfLimit * up[i]);
  }
  return settings;
}

LoadClass BandOf(double ratio, const std::array<double, 2>& limits) {
  if (!std::isfinite(ratio)) return LoadClass::kUnknown;
  return ratio > limits[1]   ? LoadClass::kHigh
         : ratio > limits[0] ? LoadClass::kMedium
                             : LoadClass::kLow;
}

LoadMeter::Reading LoadMeter::Update(double ratio, std::int64_t stamp_nanos) {
  const double step = Secs(stamp_nanos - last_nanos_);
  last_nanos_ = stamp_nanos;
  const bool starts_over = settings_.is_momentary || !std::isfinite(ratio) ||
                           reading_.load_class == LoadClass::kUnknown || step < 0 ||
                           step > kLongestGapSecs;
  if (starts_over) {
    peak_nanos_ = stamp_nanos;
    return reading_ = {ratio, BandOf(ratio, settings_.up)};
  }
  double& shown = reading_.ratio;
  if (ratio >= shown) {
    shown = ratio + Left(step, settings_.rise_secs) * (shown - ratio);
    peak_nanos_ = stamp_nanos;
  } else {
    const double since_hold = Secs(stamp_nanos - peak_nanos_) - settings_.hold_secs;
    shown = ratio + Left(std::clamp(since_hold, 0.0, step), settings_.fall_secs) * (shown - ratio);
  }
  // The lowest and the highest class that the hysteresis allows for the shown ratio.
  const LoadClass least = BandOf(shown, settings_.up);
  const LoadClass most = shown >= settings_.down[1]   ? LoadClass::kHigh
                         : shown >= settings_.down[0] ? LoadClass::kMedium
                                                      : LoadClass::kLow;
  reading_.load_class = std::clamp(reading_.load_class, least, most);
  return reading_;
}

}  // namespace kinescope::loads
