/// Continues a sample counter or time code over the rounds of a loop: each round begins one step
/// after the end of the round before. 32 bits, wraps around. One thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace kinescope::app {

class CounterSplice {
 public:
  /// Adds the next value of the source. Returns Continued(value).
  std::uint32_t Add(std::uint32_t value) {
    if (last_ && round_begins_) {
      offset_ += *last_ + step_.value_or(1) - value;
    } else if (last_) {
      LearnStep(value - *last_);
    }
    round_begins_ = false;
    last_ = value;
    return Continued(value);
  }

  /// `value` of this round as it continues the rounds before. Values of the first round stay.
  std::uint32_t Continued(std::uint32_t value) const { return value + offset_; }

  /// The next value begins a round.
  void BeginRound() { round_begins_ = true; }

 private:
  // The smallest step: larger ones are gaps. A step back is a restart of the sender.
  void LearnStep(std::uint32_t ahead) {
    constexpr std::uint32_t kBack = 0x8000'0000;
    if (ahead > 0 && ahead < kBack) step_ = std::min(step_.value_or(ahead), ahead);
  }

  std::optional<std::uint32_t> last_;  // as the source has it
  std::optional<std::uint32_t> step_;
  std::uint32_t offset_ = 0;
  bool round_begins_ = false;
};

}  // namespace kinescope::app
