/// What a stream so far lets one expect of its next header. The sample counter counts captured
/// frames and the time code is that count over the capture rate (mvn-protocol.md 1), so the two
/// vouch for each other: a header in which they do not lie on one line with the headers before is
/// damaged, or the sender has started over. Plain values, one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace kinescope::mvn {

/// How far `to` is ahead of `from`, negative where it is behind; both may wrap.
inline std::int32_t Ahead(std::uint32_t to, std::uint32_t from) {
  return static_cast<std::int32_t>(to - from);
}

/// Counter and time code of the samples of one run.
class TimeCodeLine {
 public:
  enum class Fit { kYes, kNo, kUnknown };

  /// Whether counter and time code lie on the line. Unknown after a start, and with a sender whose
  /// time code stands still or goes its own way.
  Fit Fits(std::uint32_t counter, std::uint32_t time_code_millis) const;

  /// Takes a sample that is known to be of this run; one that is off the line begins a new line.
  void Add(std::uint32_t counter, std::uint32_t time_code_millis);

  void Restart() { *this = TimeCodeLine(); }

 private:
  struct Header {
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
  };

  std::optional<Header> anchor_;
  Header newest_;
  int added_ = 0;  // since the anchor, as long as it matters
};

/// By how much the counter usually grows: a stream slower than the capture steps by more than one.
class StepMeter {
 public:
  void Add(std::uint32_t step);
  /// Whether `step` is larger than the usual ones: samples were lost.
  bool IsGap(std::uint32_t step) const;
  std::uint32_t usual() const;  // 1 before it is known

 private:
  std::array<std::uint32_t, 16> steps_{};  // ring of the latest
  std::size_t count_ = 0;                  // in all
};

}  // namespace kinescope::mvn
