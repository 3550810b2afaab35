#include "server/source/recording_length.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/system/errors.h"

namespace kinescope::app {
namespace {

// Samples with these stamps; then it ends, fails or waits for ever.
class Stamps : public Source {
 public:
  enum class End { kEnds, kFails, kNever };
  Stamps(std::vector<std::int64_t> stamps, End end) : stamps_(std::move(stamps)), end_(end) {}

  State Poll(std::chrono::milliseconds, SampleSink& sink) override {
    if (next_ < stamps_.size()) {
      BodySample sample;
      sample.stamp_nanos = stamps_[next_++];
      sink.OnSample(sample);
      return State::kMore;
    }
    if (end_ == End::kFails) throw SourceError("truncated");
    return end_ == End::kEnds ? State::kEnded : State::kMore;
  }
  SourceCounters counters() const override { return {}; }
  std::string description() const override { return "stamps"; }
  bool is_live() const override { return false; }

 private:
  const std::vector<std::int64_t> stamps_;
  const End end_;
  std::size_t next_ = 0;
};

std::optional<std::int64_t> LengthOf(const std::vector<std::int64_t>& stamps, Stamps::End end) {
  return RecordingLength([&] { return std::make_unique<Stamps>(stamps, end); }).Wait();
}

TEST(RecordingLength, IsFromTheFirstSampleToTheLatest) {
  EXPECT_EQ(LengthOf({5'000, 7'000, 6'000}, Stamps::End::kEnds), 2'000);
  EXPECT_EQ(LengthOf({5'000}, Stamps::End::kEnds), 0);
}

TEST(RecordingLength, IsUnknownWithoutASample) {
  EXPECT_EQ(LengthOf({}, Stamps::End::kEnds), std::nullopt);
}

TEST(RecordingLength, IsThatOfTheReadablePart) {
  EXPECT_EQ(LengthOf({1'000, 4'000}, Stamps::End::kFails), 3'000);
  EXPECT_EQ(LengthOf({}, Stamps::End::kFails), std::nullopt);
}

TEST(RecordingLength, GivesUpWhenItIsDestroyed) {
  const RecordingLength length(
      [] { return std::make_unique<Stamps>(std::vector<std::int64_t>{1}, Stamps::End::kNever); });
  EXPECT_EQ(length.nanos(), std::nullopt);
}

}  // namespace
}  // namespace kinescope::app
