// Captures and live streams as they are.
#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/starts_with.h"
#include "server/app/stream/stream_feed.h"
#include "server/mvn/open.h"
#include "server/source/counter_splice.h"

namespace kinescope::app {
namespace {

bool IsMvn(std::string_view bytes) { return StartsWith(bytes, "MXTP"); }

class DatagramFeed final : public Feed, private mvn::DatagramSink {
 public:
  DatagramFeed(const FeedSettings& settings, std::unique_ptr<mvn::DatagramSource> source)
      : settings_(settings), source_(std::move(source)), ids_(settings.characters) {
    if (source_->is_live()) first_arrival_ = MonotonicNanos();
  }

  State Read(std::chrono::nanoseconds timeout, std::vector<FeedDatagram>& out) override {
    out_ = &out;
    if (source_->Poll(timeout, *this) != mvn::DatagramSource::State::kEnded) return State::kMore;
    if (!settings_.loop || !is_begun_) return State::kEnded;  // an empty round: so is the next
    StartOver();
    return State::kMore;
  }

  bool is_live() const override { return source_->is_live(); }
  std::string description() const override { return source_->description(); }

 private:
  // One character's counting, so that it can go on in the next round.
  struct Track {
    Decimator decimator;
    std::uint64_t samples = 0;         // of this round
    std::uint32_t newest_counter = 0;  // as the sender has it
    CounterSplice counter, time_code;
  };

  void OnDatagram(const mvn::ReceivedDatagram& datagram) override {
    const auto header = mvn::ParseHeader(datagram.bytes);
    if (settings_.types && IsMvn(datagram.bytes) &&
        !(header && mvn::Contains(*settings_.types, header->type))) {
      return;
    }
    const std::int64_t due = DueNanos(datagram.arrival.monotonic_nanos);
    if (!header) return out_->push_back({due, std::string(datagram.bytes), false});

    mvn::HeaderPatch patch;
    bool begins_sample = false;
    if (mvn::BelongsToSample(header->type)) {
      Track& track = tracks_[header->character];
      begins_sample = Follow(*header, track);
      if (!track.decimator.Keeps(settings_.stream_hz, header->sample_counter,
                                 header->time_code_millis * kNanosPerMilli, kNanosPerMilli)) {
        return;
      }
      if (is_repeated_) {
        patch.sample_counter = track.counter.Continued(header->sample_counter);
        patch.time_code_millis = track.time_code.Continued(header->time_code_millis);
      }
    }
    for (int copy = 0; copy < settings_.characters; ++copy) {
      patch.character = ids_.Find(header->character, copy);
      if (!patch.character) continue;
      FeedDatagram one{due, std::string(datagram.bytes), begins_sample};
      mvn::PatchHeader(patch, one.bytes);
      out_->push_back(std::move(one));
    }
  }

  // Whether a new sample begins.
  static bool Follow(const mvn::Header& header, Track& track) {
    const bool is_first = track.samples == 0;
    // A late datagram is no new sample; a counter that starts over is.
    const auto ahead = static_cast<std::int32_t>(header.sample_counter - track.newest_counter);
    constexpr std::int32_t kRestart = -1000;
    if (!is_first && ahead <= 0 && ahead > kRestart) return false;
    ++track.samples;
    track.newest_counter = header.sample_counter;
    track.counter.Add(header.sample_counter);
    track.time_code.Add(header.time_code_millis);
    return true;
  }

  std::int64_t DueNanos(std::int64_t arrival) {
    if (!std::exchange(is_begun_, true) && !source_->is_live()) first_arrival_ = arrival;
    newest_arrival_ = std::max(newest_arrival_, arrival);
    const std::int64_t played = round_offset_ + arrival - first_arrival_;
    const auto due = static_cast<std::int64_t>(static_cast<double>(played) / settings_.speed);
    return last_due_ = std::max(last_due_, due);  // captures may be out of order
  }

  // Counters, time codes and time go on where they ended.
  void StartOver() {
    std::uint64_t most_samples = 0;
    for (auto& [id, track] : tracks_) {
      most_samples = std::max(most_samples, track.samples);
      track.counter.BeginRound();
      track.time_code.BeginRound();
      track.samples = 0;
    }
    const std::int64_t length = newest_arrival_ - first_arrival_;
    const std::int64_t steps = static_cast<std::int64_t>(most_samples) - 1;
    constexpr std::int64_t kPause = kNanosPerSecond;  // one sample or none: no period is known
    round_offset_ += length + (steps > 0 ? length / steps : kPause);
    newest_arrival_ = 0;
    is_begun_ = false;
    is_repeated_ = true;
    source_ = mvn::OpenDatagrams(settings_.source);
  }

  const FeedSettings settings_;
  std::unique_ptr<mvn::DatagramSource> source_;
  CharacterIds ids_;
  std::map<int, Track> tracks_;               // by the sender's id
  std::vector<FeedDatagram>* out_ = nullptr;  // during Read
  bool is_begun_ = false;                     // this round
  bool is_repeated_ = false;                  // not the first round
  std::int64_t first_arrival_ = 0;
  std::int64_t newest_arrival_ = 0;
  std::int64_t round_offset_ = 0;
  std::int64_t last_due_ = 0;
};

}  // namespace

std::unique_ptr<Feed> MakeDatagramFeed(const FeedSettings& settings,
                                       std::unique_ptr<mvn::DatagramSource> source) {
  return std::make_unique<DatagramFeed>(settings, std::move(source));
}

}  // namespace kinescope::app
