/// Notices that this machine cannot keep up with the stream: samples wait in its receive buffer, so
/// everything that is shown is old. Says so, and decides which old samples are skipped to catch
/// up. Reading thread only, except where stated.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>

#include "core/body_sample.h"

namespace kinescope::app {

class Overload {
 public:
  /// `may_skip`: there is no sink that needs every sample (ROS does).
  explicit Overload(bool may_skip) : may_skip_(may_skip) {}

  /// How long `sample` waited until `now_nanos` (monotonic clock), ns; 0 for a file.
  static std::int64_t WaitedNanos(const BodySample& sample, std::int64_t now_nanos);

  /// Whether a sample of this character that waited so long shall be processed. Some samples
  /// of each character always are, so that a lasting overload shows something.
  [[nodiscard]] bool Admit(int character, std::int64_t waited_nanos, std::int64_t now_nanos);

  /// Nothing waits any more.
  void OnIdle(std::int64_t now_nanos) { Log(0, now_nanos); }

  /// Samples that were skipped. Any thread.
  std::uint64_t skipped() const { return skipped_; }

 private:
  void Log(std::int64_t waited_nanos, std::int64_t now_nanos);

  const bool may_skip_;
  std::atomic<std::uint64_t> skipped_{0};
  std::map<int, std::int64_t> admitted_nanos_;  // when the last sample of each was admitted
  bool is_behind_ = false;
  std::int64_t said_nanos_ = 0;  // when a line was logged; 0: never
  std::uint64_t skipped_before_ = 0;
};

}  // namespace kinescope::app
