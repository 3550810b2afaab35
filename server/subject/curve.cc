#include "server/subject/curve.h"

#include <algorithm>
#include <utility>

#include "core/system/check.h"

namespace kinescope::subject {
namespace {

// Slope at a key between secants `before` and `after`, over spans of the given widths: their
// weighted harmonic mean, 0 at a turning point.
double SlopeAtKey(double before, double width_before, double after, double width_after) {
  if (before * after <= 0) return 0;
  const double w_before = 2 * width_after + width_before;
  const double w_after = width_after + 2 * width_before;
  return (w_before + w_after) / (w_before / before + w_after / after);
}

// The quintic on [0, 1] with these end values and slopes, and no second derivative at the ends.
Jet Quintic(const Jet& s, double value0, double slope0, double value1, double slope1) {
  const double rise = value1 - value0;
  const double c3 = 10 * rise - 6 * slope0 - 4 * slope1;
  const double c4 = -15 * rise + 8 * slope0 + 7 * slope1;
  const double c5 = 6 * rise - 3 * slope0 - 3 * slope1;
  return value0 + s * (slope0 + s * s * (c3 + s * (c4 + s * c5)));
}

// Integral of the quintic smoothstep from 0 to u: a start from rest.
Jet RampIntegral(const Jet& u) {
  const Jet u2 = u * u;
  return u2 * u2 * (2.5 + u * (-3.0 + u));
}

}  // namespace

Curve::Curve(double period, std::vector<Key> keys) : period_(period), keys_(std::move(keys)) {
  const std::size_t count = keys_.size();
  KINESCOPE_CHECK(count >= 2);
  KINESCOPE_CHECK(keys_.front().at >= 0 && keys_.back().at < period_);
  std::vector<double> widths(count);
  std::vector<double> secants(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool wraps = i + 1 == count;
    const Key& next = wraps ? keys_.front() : keys_[i + 1];
    widths[i] = next.at - keys_[i].at + (wraps ? period_ : 0);
    KINESCOPE_CHECK(widths[i] > 0);
    secants[i] = (next.value - keys_[i].value) / widths[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count;
    slopes_.push_back(SlopeAtKey(secants[before], widths[before], secants[i], widths[i]));
  }
}

Jet Curve::At(const Jet& x) const {
  Jet within = x;
  within.value -= period_ * std::floor(x.value / period_);
  if (within.value < keys_.front().at) within.value += period_;  // on the span that wraps
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), within.value,
                                     [](double at, const Key& key) { return at < key.at; });
  const auto i = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const bool wraps = i + 1 == keys_.size();
  const std::size_t j = wraps ? 0 : i + 1;
  const double width = keys_[j].at - keys_[i].at + (wraps ? period_ : 0);
  return Quintic((within - keys_[i].at) / width, keys_[i].value, slopes_[i] * width, keys_[j].value,
                 slopes_[j] * width);
}

Jet GlideStep(const Jet& x, double ramp) {
  if (x.value <= 0) return 0.0;
  if (x.value >= 1) return 1.0;
  if (x.value < ramp) return ramp / (1 - ramp) * RampIntegral(x / ramp);
  if (x.value > 1 - ramp) return 1.0 - ramp / (1 - ramp) * RampIntegral((1.0 - x) / ramp);
  return (x - 0.5 * ramp) / (1 - ramp);
}

}  // namespace kinescope::subject
