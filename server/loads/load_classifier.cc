#include "server/loads/load_classifier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/clocks.h"
#include "server/loads/gap.h"

namespace kinescope::loads {
namespace {

constexpr std::int64_t kNotThere = std::numeric_limits<std::int64_t>::min();

// Sets `since` to the time since which the condition has held without interruption.
void Track(bool holds, std::int64_t now, std::int64_t& since) {
  if (!holds) {
    since = kNotThere;
  } else if (since == kNotThere) {
    since = now;
  }
}

}  // namespace

LoadClassifier::Settings LoadClassifier::WithLimits(const std::array<double, 2>& up) {
  constexpr double kGap = 0.05, kGapOfLimit = 1.0 / 6;
  Settings settings;
  settings.up = up;
  for (std::size_t i = 0; i < up.size(); ++i) {
    settings.down[i] = up[i] - std::min(kGap, kGapOfLimit * up[i]);
  }
  return settings;
}

void LoadClassifier::Restart(double ratio) {
  filtered_ = ratio;
  class_ = ratio > settings_.up[1]   ? LoadClass::kHigh
           : ratio > settings_.up[0] ? LoadClass::kMedium
                                     : LoadClass::kLow;
  above_since_ = {kNotThere, kNotThere};
  below_since_ = {kNotThere, kNotThere};
}

LoadClass LoadClassifier::Update(double ratio, std::int64_t stamp_nanos) {
  const double step = Secs(stamp_nanos - last_nanos_);
  last_nanos_ = stamp_nanos;
  if (!std::isfinite(ratio)) return class_ = LoadClass::kUnknown;
  if (class_ == LoadClass::kUnknown || step < 0 || step > kLongestGapSecs) {
    Restart(ratio);
    return class_;
  }

  const double kept = settings_.low_pass_secs > 0 ? std::exp(-step / settings_.low_pass_secs) : 0.0;
  filtered_ = ratio + kept * (filtered_ - ratio);
  for (std::size_t i = 0; i < 2; ++i) {
    Track(filtered_ > settings_.up[i], stamp_nanos, above_since_[i]);
    Track(filtered_ < settings_.down[i], stamp_nanos, below_since_[i]);
  }
  const auto lasted = [&](std::int64_t since, double dwell_secs) {
    return since != kNotThere && Secs(stamp_nanos - since) >= dwell_secs - 1e-9;
  };
  // A jump over two classes passes through both in one update.
  if (class_ == LoadClass::kLow && lasted(above_since_[0], settings_.dwell_up_secs)) {
    class_ = LoadClass::kMedium;
  }
  if (class_ == LoadClass::kMedium && lasted(above_since_[1], settings_.dwell_up_secs)) {
    class_ = LoadClass::kHigh;
  }
  if (class_ == LoadClass::kHigh && lasted(below_since_[1], settings_.dwell_down_secs)) {
    class_ = LoadClass::kMedium;
  }
  if (class_ == LoadClass::kMedium && lasted(below_since_[0], settings_.dwell_down_secs)) {
    class_ = LoadClass::kLow;
  }
  return class_;
}

}  // namespace kinescope::loads
