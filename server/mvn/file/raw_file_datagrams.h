/// Reads MVN datagrams from a file in which they follow each other without anything between them:
/// the content of a TCP stream, or a `.bin` that another receiver wrote. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/input_file.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/stream_framer.h"

namespace kinescope::mvn {

/// A clock for datagrams without receive times: the sender's time codes, made monotonic. Small
/// steps back (datagrams out of order) stand still. A step by more than kFarOff in either direction
/// counts once a second datagram confirms it, so that a corrupt one has no effect. Back: the
/// sender's clock was restarted, and time continues from the newest. Forward: a pause.
class TimeCodeClock {
 public:
  /// The receive time of the next datagram, ns; never before the last. `time_code_millis`: nullopt
  /// if the datagram has none.
  std::int64_t Advance(std::optional<std::uint32_t> time_code_millis);

  /// Time of the first time code of a file, and of any datagrams before it. It is not 0, which
  /// means "no time" in ROS.
  static constexpr std::int64_t kStartNanos = kNanosPerSecond;
  static constexpr std::int64_t kFarOffMillis = 1'000;

 private:
  bool IsNear(std::int64_t millis, std::int64_t other) const;

  std::optional<std::int64_t> newest_;   // time code, ms, as sent
  std::int64_t first_ = 0;               // time code, ms, as sent
  std::optional<std::int64_t> far_off_;  // not yet confirmed
  std::int64_t restarts_millis_ = 0;     // offset from time codes to the time since the beginning
};

class RawFileDatagrams : public DatagramSource {
 public:
  /// `name` is for messages.
  RawFileDatagrams(InputFile file, std::string name);

  /// Delivers one datagram. Sender and receiver are unknown. @throws SourceError if the file cannot
  /// be read.
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
