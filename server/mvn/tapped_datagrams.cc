#include "server/mvn/tapped_datagrams.h"

#include <utility>

namespace kinescope::mvn {
namespace {

class TappedSource : public DatagramSource, private DatagramSink {
 public:
  TappedSource(std::unique_ptr<DatagramSource> source, DatagramSink& tap)
      : source_(std::move(source)), tap_(tap) {}

  [[nodiscard]] State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) override {
    sink_ = &sink;
    return source_->Poll(timeout, *this);
  }
  TransportCounters counters() const override { return source_->counters(); }
  std::string description() const override { return source_->description(); }
  bool is_live() const override { return source_->is_live(); }

 private:
  void OnDatagram(const ReceivedDatagram& datagram) override {
    tap_.OnDatagram(datagram);
    sink_->OnDatagram(datagram);
  }

  const std::unique_ptr<DatagramSource> source_;
  DatagramSink& tap_;
  DatagramSink* sink_ = nullptr;  // during Poll
};

}  // namespace

std::unique_ptr<DatagramSource> Tapped(std::unique_ptr<DatagramSource> source, DatagramSink* tap) {
  if (tap == nullptr) return source;
  return std::make_unique<TappedSource>(std::move(source), *tap);
}

}  // namespace kinescope::mvn
