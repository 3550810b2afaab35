/// Estimates how many samples of a stream are lost, from the steps of its counter. The usual step
/// is measured, because a stream slower than the acquisition steps by more than one, and by two
/// values in regular alternation if its rate does not divide that of the acquisition (240 Hz sent
/// at 100 Hz: 2, 3, 2, 3, 2). Irregular larger steps are losses. One thread; allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinescope::mvn {

class LossMeter {
 public:
  /// The number of samples that are missing between two that came, whose counters differ by `step`
  /// (at least 1). 0 for the first 32 steps, which show what is usual.
  std::uint64_t Add(std::uint32_t step);

 private:
  static constexpr std::size_t kSteps = 64;
  struct Usual {
    double step = 1;
    std::uint32_t largest = 1;  // that is no loss
    double doubt = 0;           // parts of a sample that a step may have in excess
  };
  Usual FindUsual() const;
  bool IsRegular(std::uint32_t step, std::size_t count) const;

  std::array<std::uint32_t, kSteps> steps_{};  // ring buffer of the latest
  std::size_t count_ = 0;                      // in total
};

}  // namespace kinescope::mvn
