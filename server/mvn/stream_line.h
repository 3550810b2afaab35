/// Predicts the next header of a stream. The sample counter counts captured samples, and the time
/// code is that count divided by the acquisition rate (mvn-protocol.md 1). So they confirm each
/// other: a header whose two values are not on the line of earlier headers is corrupt, or the
/// sender has started over. Plain values, one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace kinescope::mvn {

/// Distance of `to` after `from`, negative if it is before; both may wrap.
inline std::int32_t Ahead(std::uint32_t to, std::uint32_t from) {
  return static_cast<std::int32_t>(to - from);
}

/// Counter and time code of the samples of one run.
class TimeCodeLine {
 public:
  enum class Fit { kYes, kNo, kUnknown };

  /// Whether counter and time code are on the line. Unknown after a start, and with a sender whose
  /// time code stands still or is independent of the counter.
  Fit Fits(std::uint32_t counter, std::uint32_t time_code_millis) const;

  /// Adds a sample of this run; a sample off the line begins a new line.
  void Add(std::uint32_t counter, std::uint32_t time_code_millis);

  void Restart() { *this = TimeCodeLine(); }

 private:
  struct Header {
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
  };

  std::optional<Header> anchor_;
  Header newest_;
  int added_ = 0;  // since the anchor; limited
};

/// Measures the usual step of the counter: a stream slower than the acquisition steps by more than
/// one.
class StepMeter {
 public:
  void Add(std::uint32_t step);
  /// Whether `step` is larger than the usual ones, so that samples were lost.
  bool IsGap(std::uint32_t step) const;
  std::uint32_t usual() const;  // 1 until known

 private:
  std::array<std::uint32_t, 16> steps_{};  // ring buffer of the latest steps
  std::size_t count_ = 0;                  // in total
};

}  // namespace kinescope::mvn
