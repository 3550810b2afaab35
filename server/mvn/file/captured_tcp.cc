#include "server/mvn/file/captured_tcp.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "server/mvn/datagram_extent.h"

namespace kinescope::mvn {
namespace {

// A sequence number beyond any window belongs to another connection, or the capture lost more than
// can be waited for.
constexpr std::int64_t kFarOff = 1 << 24;
constexpr std::size_t kMaxSegments = 4096;

}  // namespace

void CapturedTcp::Decide(Direction& direction, std::string_view bytes) {
  direction.head.append(bytes);
  if (FindIdString(direction.head, 0) != std::string_view::npos) {
    direction.is_mvn = true;
    ++connections_;
    direction.framer.Append(direction.head);
    direction.head = {};
  } else if (direction.head.size() > kMaxUndecidedBytes) {
    direction.head.erase(0, direction.head.size() - kIdStringBytes);  // may be divided here
  }
}

void CapturedTcp::HandOn(Direction& direction, const Arrival& arrival, DatagramSink& sink) {
  while (const auto bytes = direction.framer.Next()) {
    sink.OnDatagram({direction.from, direction.to, *bytes, arrival});
  }
}

// The following bytes do not continue the earlier ones.
void CapturedTcp::Restart(Direction& direction, const Arrival& arrival, DatagramSink& sink) {
  direction.head.clear();
  if (!direction.is_mvn) return;
  direction.framer.End();
  HandOn(direction, arrival, sink);
  resyncs_ += direction.framer.resyncs();
  skipped_bytes_ += direction.framer.skipped_bytes();
  direction.framer = StreamFramer();
}

void CapturedTcp::SkipGap(Direction& direction, std::int64_t to_place, const Arrival& arrival,
                          DatagramSink& sink) {
  if (direction.is_mvn) ++gaps_;
  Restart(direction, arrival, sink);
  direction.next_sequence += static_cast<std::uint32_t>(to_place - direction.next_place);
  direction.next_place = to_place;
}

// @pre place <= direction.next_place
void CapturedTcp::Take(Direction& direction, std::int64_t place, std::string_view bytes,
                       const Arrival& arrival, DatagramSink& sink) {
  const std::int64_t known = direction.next_place - place;  // bytes received already
  if (known >= static_cast<std::int64_t>(bytes.size())) return;
  bytes.remove_prefix(static_cast<std::size_t>(known));
  direction.next_place += static_cast<std::int64_t>(bytes.size());
  direction.next_sequence += static_cast<std::uint32_t>(bytes.size());
  if (direction.is_mvn) {
    direction.framer.Append(bytes);
  } else {
    Decide(direction, bytes);
  }
  if (direction.is_mvn) HandOn(direction, arrival, sink);
}

void CapturedTcp::TakeWaiting(Direction& direction, const Arrival& arrival, DatagramSink& sink) {
  while (!direction.waiting.empty()) {
    auto first = direction.waiting.begin();
    if (first->first > direction.next_place) return;
    const std::int64_t place = first->first;
    const std::string bytes = std::move(first->second);
    direction.waiting.erase(first);
    direction.waiting_bytes -= bytes.size();
    Take(direction, place, bytes, arrival, sink);
  }
}

// Keeps bytes that arrived before the ones that they continue.
void CapturedTcp::Keep(Direction& direction, std::int64_t place, std::string_view bytes,
                       const Arrival& arrival, DatagramSink& sink) {
  if (direction.waiting.empty()) direction.waiting_since_nanos = arrival.monotonic_nanos;
  std::string& kept = direction.waiting[place];
  if (kept.size() < bytes.size()) {
    direction.waiting_bytes += bytes.size() - kept.size();
    kept = bytes;
  }
  const std::size_t most = direction.is_mvn ? kMaxWaitingBytes : kMaxUndecidedBytes;
  if (direction.waiting_bytes <= most && direction.waiting.size() <= kMaxSegments &&
      arrival.monotonic_nanos - direction.waiting_since_nanos <= kPatienceNanos) {
    return;
  }
  SkipGap(direction, direction.waiting.begin()->first, arrival, sink);
  TakeWaiting(direction, arrival, sink);
  direction.waiting_since_nanos = arrival.monotonic_nanos;  // of the next gap, if there is one
}

void CapturedTcp::Close(Directions::iterator direction, const Arrival& arrival,
                        DatagramSink& sink) {
  while (!direction->waiting.empty()) {
    SkipGap(*direction, direction->waiting.begin()->first, arrival, sink);
    TakeWaiting(*direction, arrival, sink);
  }
  Restart(*direction, arrival, sink);
  directions_.erase(direction);
}

CapturedTcp::Directions::iterator CapturedTcp::FindOrMake(const TcpSegment& segment,
                                                          const Arrival& arrival,
                                                          DatagramSink& sink) {
  auto found = std::find_if(directions_.begin(), directions_.end(), [&](const Direction& known) {
    return known.from == segment.from && known.to == segment.to;
  });
  if (found != directions_.end() && segment.is_first && segment.sequence != found->first_sequence) {
    Close(found, arrival, sink);  // a new connection between the same ports
    found = directions_.end();
  }
  if (found != directions_.end()) {
    directions_.splice(directions_.end(), directions_, found);
    return found;
  }
  if (directions_.size() == kMaxDirections) {
    // Connections without MVN data are removed first: a capture of a busy machine has hundreds of
    // them.
    auto victim = std::find_if(directions_.begin(), directions_.end(),
                               [](const Direction& known) { return !known.is_mvn; });
    Close(victim == directions_.end() ? directions_.begin() : victim, arrival, sink);
  }
  Direction direction;
  direction.from = segment.from;
  direction.to = segment.to;
  direction.first_sequence = direction.next_sequence = segment.sequence;
  return directions_.insert(directions_.end(), std::move(direction));
}

bool CapturedTcp::Add(const TcpSegment& segment, const Arrival& arrival, DatagramSink& sink) {
  const auto at = FindOrMake(segment, arrival, sink);
  Direction& direction = *at;
  const std::int64_t ahead = static_cast<std::int32_t>(segment.sequence - direction.next_sequence);
  const std::int64_t place = direction.next_place + ahead;
  const auto size = static_cast<std::int64_t>(segment.payload.size());
  if (std::abs(ahead) > kFarOff) {
    SkipGap(direction, place, arrival, sink);
    direction.waiting.clear();
    direction.waiting_bytes = 0;
    Take(direction, place, segment.payload, arrival, sink);
  } else if (ahead <= 0) {
    Take(direction, place, segment.payload, arrival, sink);
    TakeWaiting(direction, arrival, sink);
  } else if (size > 0) {
    Keep(direction, place, segment.payload, arrival, sink);
  }
  const bool is_mvn = direction.is_mvn || segment.payload.empty();
  // A FIN that overtook data waits with it; missing data are given up at the end.
  if (segment.is_reset || (segment.is_last && direction.waiting.empty())) {
    Close(at, arrival, sink);
  }
  return is_mvn;
}

void CapturedTcp::End(const Arrival& arrival, DatagramSink& sink) {
  while (!directions_.empty()) Close(directions_.begin(), arrival, sink);
}

std::uint64_t CapturedTcp::resyncs() const {
  std::uint64_t sum = resyncs_;
  for (const Direction& direction : directions_) sum += direction.framer.resyncs();
  return sum;
}

std::uint64_t CapturedTcp::skipped_bytes() const {
  std::uint64_t sum = skipped_bytes_;
  for (const Direction& direction : directions_) sum += direction.framer.skipped_bytes();
  return sum;
}

}  // namespace kinescope::mvn
