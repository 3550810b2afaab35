#include "server/mvn/loss_meter.h"

#include <algorithm>
#include <cmath>

namespace kinescope::mvn {
namespace {

constexpr std::size_t kStepsToKnow = 32;
constexpr std::size_t kFewestAlternating = 4;  // of the latest 64 steps
constexpr double kShareOfRegular = 0.7;        // also with some losses among them

}  // namespace

std::uint64_t LossMeter::Add(std::uint32_t step) {
  std::uint64_t lost = 0;
  if (count_ >= kStepsToKnow) {
    const Usual usual = FindUsual();
    const double samples = std::round(static_cast<double>(step) / usual.step - usual.doubt);
    if (step > usual.largest && samples > 1) lost = static_cast<std::uint64_t>(samples) - 1;
  }
  steps_[count_ % kSteps] = step;
  ++count_;
  return lost;
}

LossMeter::Usual LossMeter::FindUsual() const {
  const std::size_t known = std::min(count_, kSteps);
  const auto begin = steps_.begin(), end = begin + static_cast<std::ptrdiff_t>(known);
  const auto count_of = [&](std::uint32_t step) {
    return static_cast<std::size_t>(std::count(begin, end, step));
  };
  std::uint32_t most = 1;
  std::size_t most_count = 0;
  for (auto step = begin; step != end; ++step) {
    const std::size_t count = count_of(*step);
    if (count > most_count || (count == most_count && *step < most)) {
      most = *step;
      most_count = count;
    }
  }
  const std::size_t below = most > 1 ? count_of(most - 1) : 0, above = count_of(most + 1);
  const std::uint32_t other = above > below ? most + 1 : most - 1;
  const std::size_t other_count = std::max(above, below);
  if (other_count < kFewestAlternating || !IsRegular(other, other_count)) {
    return {static_cast<double>(most), most, most > 1 ? 0.49 : 0};
  }
  const double sum = static_cast<double>(most) * static_cast<double>(most_count) +
                     static_cast<double>(other) * static_cast<double>(other_count);
  return {sum / static_cast<double>(most_count + other_count), std::max(most, other), 0};
}

// Whether `step`, which is there `count` times, returns after the same number of steps, give or
// take one. Losses come at random.
bool LossMeter::IsRegular(std::uint32_t step, std::size_t count) const {
  std::array<std::size_t, kSteps> distances{};
  std::size_t found = 0, last = 0;
  const std::size_t known = std::min(count_, kSteps);
  for (std::size_t i = 0; i < known; ++i) {
    const std::size_t place = (count_ - known + i) % kSteps;
    if (steps_[place] != step) continue;
    if (last > 0) distances[found++] = i + 1 - last;
    last = i + 1;
  }
  const auto begin = distances.begin(), end = begin + static_cast<std::ptrdiff_t>(count - 1);
  const auto middle = begin + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(begin, middle, end);
  const std::size_t usual = *middle;
  const auto regular = std::count_if(begin, end, [usual](std::size_t distance) {
    return distance + 1 >= usual && distance <= usual + 1;
  });
  return static_cast<double>(regular) >= kShareOfRegular * static_cast<double>(count - 1);
}

}  // namespace kinescope::mvn
