/// Counts durations for percentiles in constant memory: 32 classes per doubling, so results are
/// accurate to 2 %. Plain values, one thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kinescope {

class DurationHistogram {
 public:
  void Add(std::int64_t nanos) {
    ++counts_[ClassOf(nanos)];
    ++total_;
    longest_ = std::max(longest_, nanos);
  }

  std::uint64_t total() const { return total_; }
  std::int64_t longest_nanos() const { return longest_; }  // exact

  /// The duration that `fraction` (0 to 1) of all durations do not exceed, ns; 0 without any.
  std::int64_t PercentileNanos(double fraction) const {
    const auto wanted =
        static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total_)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (seen > 0 && seen >= wanted) return std::min(UpperEnd(i), longest_);
    }
    return longest_;
  }

  void AddAll(const DurationHistogram& more) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += more.counts_[i];
    total_ += more.total_;
    longest_ = std::max(longest_, more.longest_);
  }
  /// What was added since `earlier`, a former value of this histogram. Its longest_nanos() is that
  /// of all.
  DurationHistogram Since(const DurationHistogram& earlier) const {
    DurationHistogram since = *this;
    for (std::size_t i = 0; i < counts_.size(); ++i) since.counts_[i] -= earlier.counts_[i];
    since.total_ -= earlier.total_;
    return since;
  }

 private:
  static constexpr int kPerDoubling = 32;
  static constexpr double kSmallest = 1'000;     // ns; shorter ones are one class
  static constexpr std::size_t kDoublings = 30;  // up to 18 minutes; longer ones are one class

  static std::size_t ClassOf(std::int64_t nanos) {
    const double ratio = static_cast<double>(std::max<std::int64_t>(nanos, 1)) / kSmallest;
    const double index = std::floor(std::log2(ratio) * kPerDoubling) + 1;
    return static_cast<std::size_t>(
        std::clamp(index, 0.0, static_cast<double>(kPerDoubling * kDoublings)));
  }
  static std::int64_t UpperEnd(std::size_t index) {
    return std::llround(kSmallest * std::exp2(static_cast<double>(index) / kPerDoubling));
  }

  std::array<std::uint64_t, kPerDoubling * kDoublings + 1> counts_{};
  std::uint64_t total_ = 0;
  std::int64_t longest_ = 0;
};

}  // namespace kinescope
