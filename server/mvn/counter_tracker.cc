#include "server/mvn/counter_tracker.h"

#include <algorithm>

namespace kinescope::mvn {
namespace {

constexpr std::uint32_t kMostFramesReordered = 120;  // half a second at 240 Hz
constexpr std::int64_t kSilenceNanos = 250'000'000;
constexpr int kLateRunOfRestart = 8;
constexpr std::size_t kStepsToJudge = 4;

}  // namespace

void CounterTracker::Forget() {
  newest_.reset();
  late_run_ = 0;
}

CounterTracker::Order CounterTracker::Take(std::uint32_t counter, std::int64_t now_nanos) {
  last_step_was_gap_ = false;
  Order order = Order::kSame;
  if (!newest_) {
    order = Order::kNewer;
  } else if (counter != *newest_) {
    // Modulo 2^32, so that the counter may wrap.
    const std::uint32_t ahead = counter - *newest_;
    if (ahead < 0x80000000U) {
      order = Order::kNewer;
      LearnStep(ahead);
    } else if (IsRestart(counter, 0U - ahead, now_nanos)) {
      order = Order::kRestart;
    } else {
      return Order::kLate;
    }
  }
  newest_ = counter;
  newest_heard_nanos_ = now_nanos;
  late_run_ = 0;
  return order;
}

bool CounterTracker::IsRestart(std::uint32_t counter, std::uint32_t behind,
                               std::int64_t now_nanos) {
  if (behind > kMostFramesReordered || now_nanos - newest_heard_nanos_ > kSilenceNanos) return true;
  if (late_run_ > 0 && counter == late_counter_) return false;  // same sample, next type
  const bool in_order = late_run_ > 0 && counter - late_counter_ < 0x80000000U;
  late_run_ = in_order ? late_run_ + 1 : 1;
  late_counter_ = counter;
  return late_run_ >= kLateRunOfRestart;
}

void CounterTracker::LearnStep(std::uint32_t step) {
  last_step_was_gap_ = step_count_ >= kStepsToJudge && step > UsualStep();
  steps_[step_count_ % steps_.size()] = step;
  ++step_count_;
}

// The largest step that makes up a quarter of the latest ones: 240 Hz sent at 100 Hz steps by 2 and
// 3 in turn, and neither is a loss.
std::uint32_t CounterTracker::UsualStep() const {
  const std::size_t known = std::min(step_count_, steps_.size());
  const auto end = steps_.begin() + static_cast<std::ptrdiff_t>(known);
  std::uint32_t usual = 0;
  for (auto step = steps_.begin(); step != end; ++step) {
    const auto times = static_cast<std::size_t>(std::count(steps_.begin(), end, *step));
    if (times * 4 >= known) usual = std::max(usual, *step);
  }
  // All different: nothing is usual, and nothing can be called a gap.
  return usual == 0 ? *std::max_element(steps_.begin(), end) : usual;
}

}  // namespace kinescope::mvn
