#include "server/mvn/stream_line.h"

#include <algorithm>
#include <cmath>

namespace kinescope::mvn {
namespace {

constexpr int kSamplesToJudge = 4;
constexpr double kRoundingMillis = 2;  // both ends are whole milliseconds
constexpr double kSlopeTolerance = 0.02;
constexpr std::size_t kStepsToJudge = 4;

}  // namespace

TimeCodeLine::Fit TimeCodeLine::Fits(std::uint32_t counter, std::uint32_t time_code_millis) const {
  if (!anchor_ || added_ < kSamplesToJudge) return Fit::kUnknown;
  const double counts = Ahead(newest_.counter, anchor_->counter);
  const double millis = Ahead(newest_.millis, anchor_->millis);
  if (counts <= 0 || millis <= 0) return Fit::kUnknown;
  const double expected = Ahead(counter, newest_.counter) * millis / counts;
  // For a short line, the accuracy of the slope is its rounding divided by its length.
  const double tolerance = kRoundingMillis + std::abs(expected) * (kSlopeTolerance + 2 / millis);
  const double error = Ahead(time_code_millis, newest_.millis) - expected;
  return std::abs(error) <= tolerance ? Fit::kYes : Fit::kNo;
}

void TimeCodeLine::Add(std::uint32_t counter, std::uint32_t time_code_millis) {
  if (!anchor_ || Fits(counter, time_code_millis) == Fit::kNo) {
    anchor_ = Header{counter, time_code_millis};
    added_ = 0;
  }
  added_ = std::min(added_ + 1, kSamplesToJudge);
  newest_ = {counter, time_code_millis};
}

void StepMeter::Add(std::uint32_t step) {
  steps_[count_ % steps_.size()] = step;
  ++count_;
}

bool StepMeter::IsGap(std::uint32_t step) const {
  return count_ >= kStepsToJudge && step > usual();
}

// The largest step that makes up a quarter of the latest ones: 240 Hz sent at 100 Hz steps by 2 and
// 3 alternately, and neither is a loss.
std::uint32_t StepMeter::usual() const {
  const std::size_t known = std::min(count_, steps_.size());
  if (known == 0) return 1;
  const auto end = steps_.begin() + static_cast<std::ptrdiff_t>(known);
  std::uint32_t usual = 0;
  for (auto step = steps_.begin(); step != end; ++step) {
    const auto times = static_cast<std::size_t>(std::count(steps_.begin(), end, *step));
    if (times * 4 >= known) usual = std::max(usual, *step);
  }
  // All different: there is no usual step, so no step is a gap.
  return usual == 0 ? *std::max_element(steps_.begin(), end) : usual;
}

}  // namespace kinescope::mvn
