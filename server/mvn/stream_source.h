/// Delivers the samples of a stream of datagrams. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "core/source.h"
#include "server/mvn/assembler.h"
#include "server/mvn/datagram_source.h"

namespace kinescope::mvn {

/// - A live stream: stamps are on the wall clock of this machine.
/// - A capture: times are those of the capture, so the same file always gives the same samples,
///   independent of the machine. arrival_nanos is 0, as for every file.
class StreamSource : public Source, private DatagramSink, private SampleSink {
 public:
  StreamSource(std::unique_ptr<DatagramSource> datagrams, StreamSettings settings);

  [[nodiscard]] State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;
  void Flush(SampleSink& sink) override { assembler_.Flush(sink); }
  SourceCounters counters() const override;
  std::string description() const override { return datagrams_->description(); }
  bool is_live() const override { return datagrams_->is_live(); }

  TransportCounters transport_counters() const { return datagrams_->counters(); }

 private:
  void OnDatagram(const ReceivedDatagram& datagram) override;
  // Receives the samples of a capture, on the way to the caller's sink.
  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  std::unique_ptr<DatagramSource> datagrams_;
  Assembler assembler_;
  SampleSink* sink_ = nullptr;  // during Poll
  std::int64_t newest_arrival_nanos_ = 0;
};

}  // namespace kinescope::mvn
