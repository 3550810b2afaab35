#include "server/mvn/file/raw_file_datagrams.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kChunkBytes = 64 * 1024;

std::optional<std::uint32_t> TimeCodeOf(std::string_view datagram) {
  const auto header = ParseHeader(datagram);
  if (!header || !BelongsToSample(header->type)) return std::nullopt;
  return header->time_code_millis;
}

}  // namespace

bool TimeCodeClock::IsNear(std::int64_t millis, std::int64_t other) const {
  return std::abs(millis - other) <= kFarOffMillis;
}

std::int64_t TimeCodeClock::Advance(std::optional<std::uint32_t> time_code_millis) {
  if (time_code_millis) {
    const std::int64_t millis = *time_code_millis;
    if (!newest_) first_ = millis;
    if (!newest_ || IsNear(millis, *newest_)) {
      newest_ = std::max(millis, newest_.value_or(millis));
      far_off_.reset();
    } else if (!far_off_ || !IsNear(millis, *far_off_)) {
      far_off_ = millis;
    } else {
      const std::int64_t step = std::max(millis, *far_off_) - *newest_;
      if (step < 0) restarts_millis_ -= step;
      *newest_ += step;
      far_off_.reset();
    }
  }
  return kStartNanos + (newest_.value_or(first_) - first_ + restarts_millis_) * kNanosPerMilli;
}

RawFileDatagrams::RawFileDatagrams(InputFile file, std::string name)
    : name_(std::move(name)), file_(std::move(file)), chunk_(kChunkBytes) {}

void RawFileDatagrams::ReadChunk() {
  const std::size_t size = std::fread(chunk_.data(), 1, chunk_.size(), file_.get());
  if (std::ferror(file_.get()) != 0) {
    throw SourceError(name_ + ": reading stopped: " + file_.failure() + "; copy it again");
  }
  framer_.Append({chunk_.data(), size});
  read_all_ = size < chunk_.size();
  if (read_all_) framer_.End();
}

DatagramSource::State RawFileDatagrams::Poll(std::chrono::nanoseconds /*timeout*/,
                                             DatagramSink& sink) {
  auto datagram = framer_.Next();
  if (!datagram && !read_all_) {
    ReadChunk();
    datagram = framer_.Next();
  }
  if (!datagram) return read_all_ ? State::kEnded : State::kMore;
  const std::int64_t nanos = clock_.Advance(TimeCodeOf(*datagram));
  sink.OnDatagram({Endpoint(), Endpoint(), *datagram, {nanos, nanos}});
  return State::kMore;
}

TransportCounters RawFileDatagrams::counters() const {
  TransportCounters counters;
  counters.resyncs = framer_.resyncs();
  counters.skipped_bytes = framer_.skipped_bytes();
  return counters;
}

}  // namespace kinescope::mvn
