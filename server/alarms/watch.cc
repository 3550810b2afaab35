#include "server/alarms/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinescope::alarms {
namespace {

// Between two values that follow each other; a longer time without values is unknown.
constexpr std::int64_t kLongestStepNanos = 1'000'000'000;

bool IsTooSmall(const Rule& rule) { return rule.quantity == Quantity::kMargin; }

std::int64_t NanosOf(double secs) { return std::llround(secs * 1e9); }

// Far enough inside the limit.
bool IsInside(const Rule& rule, double value) {
  return IsTooSmall(rule) ? value >= rule.limit + rule.band : value <= rule.limit - rule.band;
}

}  // namespace

bool IsBeyond(const Rule& rule, double value) {
  return IsTooSmall(rule) ? value < rule.limit : value > rule.limit;
}

double Worse(const Rule& rule, double one, double other) {
  return IsTooSmall(rule) ? std::min(one, other) : std::max(one, other);
}

std::int64_t Watch::CountedUntil(const Moment& at) {
  const auto before = std::exchange(known_at_, at.made_nanos);
  if (!before || at.made_nanos - *before > kLongestStepNanos) return 0;
  return at.made_nanos - *before;
}

Watch::Step Watch::OnValue(const Rule& rule, std::optional<double> value, const Moment& at) {
  if (!value) {
    known_at_.reset();
    return Step::kNothing;
  }
  const std::int64_t counted = CountedUntil(at);
  const bool was_waiting = is_waiting_;
  is_waiting_ = is_on_ ? IsInside(rule, *value) : IsBeyond(rule, *value);
  if (is_on_ || was_waiting) worst_ = Worse(rule, worst_, *value);
  if (!is_waiting_) return Step::kNothing;
  waited_nanos_ = was_waiting ? waited_nanos_ + counted : 0;
  if (!is_on_ && !was_waiting) {
    since_ = at;
    worst_ = *value;
  }
  if (waited_nanos_ < NanosOf(is_on_ ? rule.over_secs : rule.for_secs)) return Step::kNothing;
  is_waiting_ = false;
  is_on_ = !is_on_;
  return is_on_ ? Step::kBegins : Step::kEnds;
}

Watch::Step Watch::OnGone() {
  const bool was_on = is_on_;
  *this = Watch();
  return was_on ? Step::kEnds : Step::kNothing;
}

}  // namespace kinescope::alarms
