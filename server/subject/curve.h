/// Schedules: smooth curves through a few chosen values, evaluated with their derivatives.
#pragma once

#include <vector>

#include "server/subject/jet.h"

namespace kinescope::subject {

/// A periodic curve through keys, twice continuously differentiable. Between two keys it is a
/// quintic that has no acceleration at either end; slopes at keys are chosen (Fritsch-Carlson) so
/// that it never overshoots: equal neighbours make it exactly constant between them.
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

/// 0 up to x = 0, 1 from x = 1 on, with continuous second derivative; steady in the middle,
/// starting and ending over `ramp` (0..0.5) of the way: its steepest slope is 1 / (1 - ramp).
Jet GlideStep(const Jet& x, double ramp);

}  // namespace kinescope::subject
