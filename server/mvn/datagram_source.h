/// Where MVN datagrams come from, before anybody looks into them: a socket, a capture file. What
/// every transport has in common, so that joining (assembler.h), recording and inspecting need not
/// know which one it is. One thread uses a source.
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
  Endpoint to;             // address zero where the transport does not tell
  std::string_view bytes;  // valid during the call only
  Arrival arrival;         // a file: both clocks are the time at which it was captured
};

class DatagramSink {
 public:
  virtual ~DatagramSink() = default;
  virtual void OnDatagram(const ReceivedDatagram& datagram) = 0;
};

/// What the transport itself saw; what the datagrams say is counted by the assembler.
struct TransportCounters {
  int receive_buffer_bytes = 0;           // what the kernel really gave; 0: no socket
  std::uint64_t kernel_drops = 0;         // datagrams lost because nobody read them in time
  std::uint64_t connections = 0;          // TCP: accepted or made, in all
  int connections_open = 0;               // TCP: now
  std::uint64_t connections_refused = 0;  // TCP: one too many
  std::uint64_t connections_lost = 0;     // TCP: ended by the other side or by an error
  std::uint64_t resyncs = 0;              // byte streams: times that the next MXTP was searched for
  std::uint64_t skipped_bytes = 0;        // byte streams: passed over by these searches
  std::uint64_t other_packets = 0;        // capture files: packets that are no UDP or TCP payload
  std::uint64_t incomplete_packets = 0;   // capture files: cut short by the capture, lost fragments

  /// Each with the name that people read it by.
  template <class Counter>
  void Visit(const Counter& counter) const {
    counter("receive_buffer_bytes", static_cast<std::uint64_t>(receive_buffer_bytes));
    counter("kernel_drops", kernel_drops);
    counter("connections", connections);
    counter("connections_open", static_cast<std::uint64_t>(connections_open));
    counter("connections_refused", connections_refused);
    counter("connections_lost", connections_lost);
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
    kMore,   // there is more to read at once
    kIdle,   // all that has come was handed on (live sources)
    kEnded,  // a file's end; stays so
  };

  /// Waits at most `timeout` for input and hands on what came, a bounded number of datagrams. A
  /// file never waits and hands on one packet's worth a call.
  /// @throws SourceError when it cannot go on (a file that is broken, a socket that fails).
  [[nodiscard]] virtual State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) = 0;

  virtual TransportCounters counters() const = 0;
  virtual std::string description() const = 0;  // "udp://0.0.0.0:9763", with the real port
  virtual bool is_live() const = 0;

 protected:
  DatagramSource() = default;
};

}  // namespace kinescope::mvn
