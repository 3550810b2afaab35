/// Watches one value by one rule: delays, band and what is unknown. No clock of its own; one
/// thread.
#pragma once

#include <cstdint>
#include <optional>

#include "server/alarms/rule.h"

namespace kinescope::alarms {

/// When something was: in a state that viewers can look back to.
struct Moment {
  std::uint64_t state = 0;       // SceneState::number
  std::int64_t made_nanos = 0;   // SceneState::made_nanos
  std::int64_t stamp_nanos = 0;  // of its newest sample, ROS time
};

class Watch {
 public:
  enum class Step { kNothing, kBegins, kEnds };

  /// `value`: nullopt if it is unknown, which neither begins nor ends an alarm; that time does not
  /// count for its delays. @pre `at` is not before that of the last call
  Step OnValue(const Rule& rule, std::optional<double> value, const Moment& at);
  /// There is no such value any more. kEnds if the alarm was on.
  Step OnGone();

  bool is_on() const { return is_on_; }
  /// Since the value is beyond the limit: the first sample, not the end of the delay.
  /// @pre is_on() or it has just ended
  const Moment& since() const { return since_; }
  double worst() const { return worst_; }  // since then

 private:
  std::int64_t CountedUntil(const Moment& at);

  bool is_on_ = false;
  bool is_waiting_ = false;               // the value is where it changes is_on_ after the delay
  std::int64_t waited_nanos_ = 0;         // of that delay
  Moment since_;                          // while on, or waiting for it
  double worst_ = 0;                      // while on, or waiting for it
  std::optional<std::int64_t> known_at_;  // made_nanos of the value before; none: it was unknown
};

/// Whether `value` is beyond the limit, of a rule for what must not be large or not be small.
bool IsBeyond(const Rule& rule, double value);

/// The worse of two values.
double Worse(const Rule& rule, double one, double other);

}  // namespace kinescope::alarms
