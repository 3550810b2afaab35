#include "server/source/recording_length.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::app {
namespace {

class Span : public SampleSink {
 public:
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override { Add(sample.stamp_nanos); }
  void OnObjects(const ObjectsSample& objects) override { Add(objects.stamp_nanos); }
  void OnMoment(const SourceMoment& moment) override { Add(moment.stamp_nanos); }

  std::optional<std::int64_t> length;

 private:
  void Add(std::int64_t stamp) {
    if (!length) first_ = stamp;
    length = std::max(length.value_or(0), stamp - first_);
  }

  std::int64_t first_ = 0;
};

}  // namespace

RecordingLength::RecordingLength(std::function<std::unique_ptr<Source>()> open)
    : length_(
          std::async(std::launch::async, [this, open = std::move(open)] { return Read(open); })) {}

RecordingLength::~RecordingLength() {
  is_ending_ = true;
  length_.wait();
}

std::optional<std::int64_t> RecordingLength::nanos() const {
  const bool is_known = length_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return is_known ? length_.get() : std::nullopt;
}

RecordingLength::Length RecordingLength::Read(
    const std::function<std::unique_ptr<Source>()>& open) const {
  Span span;
  try {
    const std::unique_ptr<Source> source = open();
    while (source->Poll(std::chrono::milliseconds(0), span) == Source::State::kMore) {
      if (is_ending_) return std::nullopt;
    }
  } catch (const SourceError&) {
    // The source that is played reports the reason.
  }
  return span.length;
}

}  // namespace kinescope::app
