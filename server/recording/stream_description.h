/// What a stream says once and then seldom: the names, colours and segment lengths of its people. A
/// recording that begins in the middle of the stream begins with it, so that it is complete. One
/// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "server/mvn/datagram_source.h"

namespace kinescope::recording {

class StreamDescription {
 public:
  /// Keeps a copy of a datagram with meta data or scale data, in the place of the one before it.
  void OnDatagram(const mvn::ReceivedDatagram& datagram);

  /// Passes on what was kept, as if it arrived at `arrival`.
  void PassTo(mvn::DatagramSink& sink, const mvn::Arrival& arrival) const;

  /// Of datagrams; beyond it the oldest ones are dropped. 4 MB of the largest ones, of senders that
  /// mean harm.
  static constexpr std::size_t kMost = 64;

 private:
  struct Kept {
    mvn::Endpoint from, to;
    int type = 0, character = 0, part = 0;
    std::string bytes;
  };
  std::deque<Kept> kept_;
};

}  // namespace kinescope::recording
