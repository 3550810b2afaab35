/// Restores MVN datagrams from captured TCP packets: the bytes in order, each once, despite losses,
/// repetitions and reordering in the capture. Only connections that carry MVN datagrams are
/// followed; memory is limited. One thread.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <string_view>

#include "server/mvn/datagram_source.h"
#include "server/mvn/file/packet.h"
#include "server/mvn/stream_framer.h"

namespace kinescope::mvn {

class CapturedTcp {
 public:
  /// Adds a segment captured at `arrival` and delivers the datagrams that it completes.
  /// @return false for data of a connection that is not (yet) known to carry MVN.
  [[nodiscard]] bool Add(const TcpSegment& segment, const Arrival& arrival, DatagramSink& sink);

  /// End of the capture: delivers everything that waits for missing segments.
  void End(const Arrival& arrival, DatagramSink& sink);

  std::uint64_t connections() const { return connections_; }  // connections that were followed
  std::uint64_t gaps() const { return gaps_; }                // missing pieces in these connections
  std::uint64_t resyncs() const;
  std::uint64_t skipped_bytes() const;

  /// Limits per direction of a connection: beyond any of them a gap counts as a loss. An undecided
  /// connection has a smaller limit.
  static constexpr std::int64_t kPatienceNanos = 2'000'000'000;  // retransmissions take less time
  static constexpr std::size_t kMaxWaitingBytes = 1 << 20;
  static constexpr std::size_t kMaxUndecidedBytes = 16 << 10;
  static constexpr std::size_t kMaxDirections = 32;

 private:
  // One direction of a connection. Places are counted from an arbitrary 0 in 64 bits, so that they
  // do not wrap as sequence numbers do.
  struct Direction {
    Endpoint from, to;
    bool is_mvn = false;
    std::string head;                  // bytes of an undecided connection
    std::uint32_t first_sequence = 0;  // at the first captured segment
    std::uint32_t next_sequence = 0;
    std::int64_t next_place = 0;
    std::map<std::int64_t, std::string> waiting;  // by place; bytes after a gap
    std::size_t waiting_bytes = 0;
    std::int64_t waiting_since_nanos = 0;
    StreamFramer framer;
  };
  using Directions = std::list<Direction>;  // the most recently used is last

  Directions::iterator FindOrMake(const TcpSegment& segment, const Arrival& arrival,
                                  DatagramSink& sink);
  void Close(Directions::iterator direction, const Arrival& arrival, DatagramSink& sink);
  void Take(Direction& direction, std::int64_t place, std::string_view bytes,
            const Arrival& arrival, DatagramSink& sink);
  void Keep(Direction& direction, std::int64_t place, std::string_view bytes,
            const Arrival& arrival, DatagramSink& sink);
  void TakeWaiting(Direction& direction, const Arrival& arrival, DatagramSink& sink);
  void SkipGap(Direction& direction, std::int64_t to_place, const Arrival& arrival,
               DatagramSink& sink);
  void Restart(Direction& direction, const Arrival& arrival, DatagramSink& sink);
  void Decide(Direction& direction, std::string_view bytes);
  static void HandOn(Direction& direction, const Arrival& arrival, DatagramSink& sink);

  Directions directions_;
  std::uint64_t connections_ = 0;
  std::uint64_t gaps_ = 0;
  std::uint64_t resyncs_ = 0;        // of framers that no longer exist
  std::uint64_t skipped_bytes_ = 0;  // of framers that no longer exist
};

}  // namespace kinescope::mvn
