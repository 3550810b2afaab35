/// Smooth curves through a few chosen values, evaluated with their derivatives. Any thread;
/// constant after construction.
#pragma once

#include <vector>

#include "server/subject/jet.h"

namespace kinescope::subject {

/// A periodic curve through keyframes, twice continuously differentiable. Between two keyframes it
/// is a quintic without acceleration at either end. The slopes at keyframes (Fritsch-Carlson)
/// exclude overshoot: between equal neighbours the curve is exactly constant.
class Curve {
 public:
  struct Key {
    double at;
    double value;
  };

  /// @pre at least two keys, strictly ascending, all within [0, period)
  Curve(double period, std::vector<Key> keys);

  Jet At(const Jet& x) const;

 private:
  double period_;
  std::vector<Key> keys_;
  std::vector<double> slopes_;
};

/// 0 up to x = 0, 1 from x = 1 on, with a continuous second derivative. It is linear in the middle
/// and starts and ends over `ramp` (0..0.5) of the way; its steepest slope is 1 / (1 - ramp).
Jet GlideStep(const Jet& x, double ramp);

}  // namespace kinescope::subject
