#include "server/mvn/stream_source.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "server/mvn/open.h"

namespace kinescope::mvn {
namespace {

using std::chrono::nanoseconds;

}  // namespace

StreamSource::StreamSource(std::unique_ptr<DatagramSource> datagrams, Stamps stamps)
    : datagrams_(std::move(datagrams)), assembler_(stamps) {}

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
  if (is_live()) {
    if (const auto deadline = assembler_.deadline_nanos()) {
      wait = std::clamp(nanoseconds(*deadline - MonotonicNanos()), nanoseconds(0), wait);
    }
  }
  switch (datagrams_->Poll(wait, *this)) {
    // The rest of an overdue sample may wait in the socket, so the time is that of its datagrams.
    case DatagramSource::State::kMore:
      if (is_live()) assembler_.Expire(newest_arrival_nanos_, sink);
      break;
    case DatagramSource::State::kIdle:
      if (is_live()) assembler_.Expire(MonotonicNanos(), sink);
      break;
    case DatagramSource::State::kEnded: assembler_.Flush(*this); return State::kEnded;
  }
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
  return std::make_unique<StreamSource>(std::move(datagrams), settings.stamps);
}

}  // namespace kinescope::mvn
