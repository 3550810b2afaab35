#include "server/mvn/stream_source.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "server/mvn/open.h"

namespace kinescope::mvn {
namespace {

using std::chrono::nanoseconds;

}  // namespace

StreamSource::StreamSource(std::unique_ptr<DatagramSource> datagrams, StreamSettings settings)
    : datagrams_(std::move(datagrams)), assembler_(settings) {}

void StreamSource::OnDatagram(const ReceivedDatagram& datagram) {
  // In a capture the packets define the time, so samples that fall due between two packets are
  // delivered now.
  if (!is_live()) assembler_.Expire(datagram.arrival.monotonic_nanos, *this);
  newest_arrival_nanos_ = datagram.arrival.monotonic_nanos;
  assembler_.Add(datagram.from, datagram.bytes, datagram.arrival, is_live() ? *sink_ : *this);
}

void StreamSource::OnCharacter(const Character& character) { sink_->OnCharacter(character); }

void StreamSource::OnSample(const BodySample& sample) {
  BodySample recorded = sample;
  recorded.arrival_nanos = 0;
  sink_->OnSample(recorded);
}

void StreamSource::OnObjects(const ObjectsSample& sample) {
  ObjectsSample recorded = sample;
  recorded.arrival_nanos = 0;
  sink_->OnObjects(recorded);
}

Source::State StreamSource::Poll(std::chrono::milliseconds timeout, SampleSink& sink) {
  sink_ = &sink;
  nanoseconds wait = timeout;
  const std::int64_t begin_nanos = is_live() ? MonotonicNanos() : 0;
  if (is_live()) {
    if (const auto deadline = assembler_.deadline_nanos()) {
      wait = std::clamp(nanoseconds(*deadline - begin_nanos), nanoseconds(0), wait);
    }
  }
  const std::uint64_t known = assembler_.tally().datagrams;
  if (datagrams_->Poll(wait, *this) == DatagramSource::State::kEnded) {
    assembler_.Flush(*this);
    return State::kEnded;
  }
  if (!is_live()) return State::kMore;
  // This thread may be interrupted at any point while datagrams fill the socket, so a sample is
  // overdue only by the time of what was read, or of a wait in which nothing came.
  const bool is_idle = assembler_.tally().datagrams == known;
  assembler_.Expire(
      is_idle ? std::min(MonotonicNanos(), begin_nanos + wait.count()) : newest_arrival_nanos_,
      sink);
  return State::kMore;
}

SourceCounters StreamSource::counters() const {
  SourceCounters counters = assembler_.counters();
  datagrams_->counters().Visit([&counters](const char* name, std::uint64_t value) {
    if (value > 0) counters.transport[name] = value;
  });
  return counters;
}

std::unique_ptr<Source> OpenStream(std::unique_ptr<DatagramSource> datagrams,
                                   const StreamSettings& settings) {
  return std::make_unique<StreamSource>(std::move(datagrams), settings);
}

}  // namespace kinescope::mvn
