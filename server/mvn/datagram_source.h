/// Source of raw MVN datagrams: a socket or a capture file. A common interface of all transports,
/// so that assembling (assembler.h), recording and inspecting do not depend on the transport. A
/// source is used by one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "server/mvn/arrival.h"
#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

struct ReceivedDatagram {
  Endpoint from;
  Endpoint to;             // all zero if the transport does not provide it
  std::string_view bytes;  // valid during the call only
  Arrival arrival;         // a file: both clocks are the time of capture
};

class DatagramSink {
 public:
  virtual ~DatagramSink() = default;
  virtual void OnDatagram(const ReceivedDatagram& datagram) = 0;
};

/// Counters of the transport itself; the assembler counts the content of the datagrams.
struct TransportCounters {
  int receive_buffer_bytes = 0;           // size that the kernel granted; 0: no socket
  std::uint64_t kernel_drops = 0;         // datagrams lost because they were not read in time
  std::uint64_t clock_steps = 0;          // times that the wall clock of this machine was set
  std::uint64_t connections = 0;          // TCP: accepted or made, in total
  int connections_open = 0;               // TCP: now
  std::uint64_t connections_refused = 0;  // TCP: beyond the limit of connections
  std::uint64_t connections_lost = 0;     // TCP: ended by the other side or by an error
  std::uint64_t connections_ended = 0;    // TCP: idle ones, and those that made room for another
  std::uint64_t strangers = 0;            // datagrams (TCP: connections) of senders that are not
                                          // allowed
  std::uint64_t resyncs = 0;              // byte streams: searches for the next MXTP
  std::uint64_t skipped_bytes = 0;        // byte streams: bytes skipped by these searches
  std::uint64_t other_packets = 0;        // capture files: packets without UDP or TCP payload
  std::uint64_t incomplete_packets = 0;   // capture files: truncated by the capture, or with lost
                                          // fragments

  /// Calls `counter` with the public name and value of each.
  template <class Counter>
  void Visit(const Counter& counter) const {
    counter("receive_buffer_bytes", static_cast<std::uint64_t>(receive_buffer_bytes));
    counter("kernel_drops", kernel_drops);
    counter("clock_steps", clock_steps);
    counter("connections", connections);
    counter("connections_open", static_cast<std::uint64_t>(connections_open));
    counter("connections_refused", connections_refused);
    counter("connections_lost", connections_lost);
    counter("connections_ended", connections_ended);
    counter("strangers", strangers);
    counter("resyncs", resyncs);
    counter("skipped_bytes", skipped_bytes);
    counter("other_packets", other_packets);
    counter("incomplete_packets", incomplete_packets);
  }
};

class DatagramSource {
 public:
  virtual ~DatagramSource() = default;
  DatagramSource(const DatagramSource&) = delete;
  DatagramSource& operator=(const DatagramSource&) = delete;

  enum class State {
    kMore,   // call again, more may be available at once
    kIdle,   // everything received was delivered (live sources)
    kEnded,  // end of a file; final
  };

  /// Waits at most `timeout` for input and delivers it to `sink`, a limited number of datagrams per
  /// call. A file never waits and delivers the datagrams of one packet per call.
  /// @throws SourceError if it cannot continue (a damaged file, a socket that fails).
  [[nodiscard]] virtual State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) = 0;

  virtual TransportCounters counters() const = 0;
  virtual std::string description() const = 0;  // "udp://0.0.0.0:9763", with the actual port
  virtual bool is_live() const = 0;

 protected:
  DatagramSource() = default;
};

}  // namespace kinescope::mvn
