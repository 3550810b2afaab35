/// MVN datagrams from a file in which they follow each other with nothing in between: what a TCP
/// stream carried, or what somebody's receiver appended to a `.bin`. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/input_file.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/stream_framer.h"

namespace kinescope::mvn {

/// A clock for datagrams without times of arrival: the sender's own time codes, made to run on.
/// Milliseconds that step back a little (datagrams out of order) stand still; a step by more than
/// kFarOff either way counts once a second datagram confirms it, so that a damaged one moves
/// nothing. Back: the sender's clock was restarted, and time goes on from the newest. Forward: a
/// pause.
class TimeCodeClock {
 public:
  /// The arrival of the next datagram, never before the last; `time_code_millis`: nullopt where it
  /// carries none.
  std::int64_t Advance(std::optional<std::uint32_t> time_code_millis);

  /// Where the first time code of a file lies, and what comes before it: not at 0, which means "no
  /// time" to ROS.
  static constexpr std::int64_t kStartNanos = 1'000'000'000;
  static constexpr std::int64_t kFarOffMillis = 1'000;

 private:
  bool IsNear(std::int64_t millis, std::int64_t other) const;

  std::optional<std::int64_t> newest_;   // time code, ms, as sent
  std::int64_t first_ = 0;               // likewise
  std::optional<std::int64_t> far_off_;  // one that nothing has confirmed
  std::int64_t restarts_millis_ = 0;     // from time codes to time since the beginning
};

class RawFileDatagrams : public DatagramSource {
 public:
  /// `name` is for people.
  RawFileDatagrams(InputFile file, std::string name);

  /// Hands on one datagram. Neither end of it is known. @throws SourceError as the file does.
  [[nodiscard]] State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) override;

  TransportCounters counters() const override;
  std::string description() const override { return name_; }
  bool is_live() const override { return false; }

 private:
  void ReadChunk();

  std::string name_;
  InputFile file_;
  StreamFramer framer_;
  TimeCodeClock clock_;
  std::vector<char> chunk_;
  bool read_all_ = false;
};

}  // namespace kinescope::mvn
