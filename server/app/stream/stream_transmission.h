/// Sends a feed in real time through fault injection, and counts it. Every datagram has a deadline
/// relative to the beginning, so that delays do not add up. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "server/app/progress.h"
#include "server/app/stream/stream_feed.h"
#include "server/mvn/faults.h"
#include "server/mvn/net/sender.h"

namespace kinescope::app {

class Transmission {
 public:
  /// All references are borrowed.
  Transmission(Feed& feed, mvn::FaultInjector& faults, mvn::DatagramSender& sender)
      : feed_(feed), faults_(faults), sender_(sender) {}

  /// Sends until the feed ends, the next datagram is due after `seconds` (0: no limit), or the
  /// program is interrupted; then sends the datagrams that faults still delay.
  /// @throws SourceError if the source or the sender cannot continue.
  void Run(double seconds);

  double secs() const { return progress_.secs(); }
  std::uint64_t samples() const { return samples_; }      // before faults
  std::uint64_t datagrams() const { return datagrams_; }  // sent
  std::uint64_t bytes() const { return bytes_; }
  /// Number of datagrams sent, by "02"; "other": without a readable header.
  std::map<std::string, std::uint64_t> types() const;

 private:
  void RunLive(std::int64_t end_nanos);
  void RunPaced(std::int64_t end_nanos);
  void Drain();
  std::int64_t Now() const;
  bool SleepUntil(std::int64_t nanos) const;
  void Admit(const FeedDatagram& datagram);
  void SendBefore(std::int64_t nanos);
  void SendNext();

  Feed& feed_;
  mvn::FaultInjector& faults_;
  mvn::DatagramSender& sender_;
  std::int64_t start_nanos_ = 0;  // monotonic clock
  Progress progress_{"samples sent:", 0};
  std::uint64_t samples_ = 0;
  std::uint64_t datagrams_ = 0;
  std::uint64_t bytes_ = 0;
  std::array<std::uint64_t, 26> by_type_{};
  std::uint64_t other_ = 0;
};

}  // namespace kinescope::app
