// Recordings of samples and the built-in subject, encoded.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/app/stream/stream_feed.h"
#include "server/app/stream/synthetic_gloves.h"
#include "server/source/counter_splice.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

// Meta and scale data go out again this often, so that a receiver may start at any time.
constexpr std::int64_t kCharacterEveryNanos = kNanosPerSecond;
constexpr double kSideBySide = 1;               // m, from copy to copy, along y
constexpr std::int64_t kClockStepNanos = 1000;  // stamps are computed, not measured

mvn::TypeSet TypesOf(const FeedSettings& settings) {
  if (settings.types) return *settings.types;
  return mvn::UsualTypes() | mvn::MakeTypeSet({mvn::Type::kMetaData, mvn::Type::kScale});
}

void MoveAside(double metres, BodySample& sample) {
  const Eigen::Vector3d offset(0, metres, 0);
  for (SegmentState& segment : sample.segments) segment.position += offset;
  for (urdf::Pose& pose : sample.fingers_and_props.poses) pose.position += offset;
  if (sample.com) sample.com->position += offset;
}

void MoveAside(double metres, ObjectsSample& sample) {
  for (urdf::Pose& pose : sample.poses) pose.position.y() += metres;
}

class SampleFeed final : public Feed, private SampleSink {
 public:
  explicit SampleFeed(const FeedSettings& settings)
      : settings_(settings),
        types_(TypesOf(settings)),
        is_subject_(IsSubjectUrl(settings.source)),
        source_(Open()),
        ids_(settings.characters),
        start_wall_(WallNanos()) {}

  State Read(std::chrono::nanoseconds, std::vector<FeedDatagram>& out) override {
    out_ = &out;
    if (source_->Poll(std::chrono::milliseconds(0), *this) == Source::State::kMore) {
      return State::kMore;
    }
    if (!settings_.loop || !is_begun_) return State::kEnded;  // an empty round: so is the next
    StartOver();
    return State::kMore;
  }

  bool is_live() const override { return false; }
  std::string description() const override { return source_->description(); }

 private:
  // One character as the source knows it.
  struct Track {
    Character character;
    urdf::Landmarks landmarks;          // of the character, to send
    bool is_described = false;          // by the source
    std::int64_t described_nanos = -1;  // when it was sent last; -1: it has changed since
    Decimator decimator;
    std::uint64_t samples = 0;  // of this round
    CounterSplice counter;
    std::int64_t time_code_base = 0;  // at the beginning of the stream
  };

  std::unique_ptr<Source> Open() const {
    SourceSettings source;
    source.subject_rate_hz = settings_.rate_hz;
    return OpenSource(settings_.source, source);
  }

  void OnCharacter(const Character& character) override {
    Track& track = tracks_[character.id];
    track.character = character;
    AddGlovesAndProps(settings_.gloves, settings_.props, track.character);
    track.landmarks = mvn::LandmarksToSend(track.character);
    // Every round of a loop begins with the same people.
    if (!is_repeated_ || !track.is_described) track.described_nanos = -1;
    track.is_described = true;
  }

  void OnSample(const BodySample& received) override {
    if (settings_.types && !std::exchange(types_are_checked_, true)) CheckTypes(received);
    BodySample sample = received;
    if (!sample.utc_millis_of_day && sample.has_time_of_day) {
      constexpr std::int64_t kMillisPerDay = 86'400'000;
      const std::int64_t millis = sample.stamp_nanos / kNanosPerMilli % kMillisPerDay;
      sample.utc_millis_of_day =
          static_cast<std::int32_t>(millis < 0 ? millis + kMillisPerDay : millis);
    }
    Take(sample, [&](const Track& track, BodySample& made) {
      AddGlovesAndProps(settings_.gloves, settings_.props,
                        static_cast<double>(made.stamp_nanos) * 1e-9, track.character, made);
    });
  }

  void OnObjects(const ObjectsSample& sample) override {
    Take(sample, [](const Track&, ObjectsSample&) {});
  }

  // Nothing is sent in the place of what the source does not have. The built-in subject wears
  // simulated trackers and lives now.
  void CheckTypes(const BodySample& sample) const {
    const auto track = tracks_.find(sample.character);
    const bool has_skeleton = track != tracks_.end() && track->second.character.skeleton;
    const std::pair<mvn::Type, std::pair<bool, const char*>> needs[] = {
        {mvn::Type::kMarkers, {has_skeleton, "landmarks"}},
        {mvn::Type::kScale, {has_skeleton, "segment lengths"}},
        {mvn::Type::kJointAngles, {sample.streamed_angles_deg.has_value(), "joint angles"}},
        {mvn::Type::kLinear, {sample.has_linear, "velocities and accelerations"}},
        {mvn::Type::kAngular, {sample.has_angular, "angular velocities and accelerations"}},
        {mvn::Type::kTrackers, {is_subject_ || sample.has_tracker.any(), "trackers"}},
        {mvn::Type::kCenterOfMass, {sample.com.has_value(), "centre of mass"}},
        {mvn::Type::kTimeCode,
         {is_subject_ || sample.has_time_of_day || sample.utc_millis_of_day, "time of day"}}};
    for (const auto& [type, need] : needs) {
      const auto& [has_it, what] = need;
      if (has_it || !mvn::Contains(types_, type)) continue;
      throw UsageError(fmt::format("--types: {:02}: {} contains no {}; leave out this type",
                                   static_cast<int>(type), settings_.source, what));
    }
  }

  template <class Sample, class AddMore>
  void Take(Sample sample, const AddMore& add_more) {
    if (!std::exchange(is_begun_, true)) first_stamp_ = sample.stamp_nanos;
    last_played_ = std::max(last_played_, round_offset_ + sample.stamp_nanos - first_stamp_);
    Track& track = tracks_[sample.character];
    const std::int64_t played_millis =
        std::llround(static_cast<double>(last_played_) / static_cast<double>(kNanosPerMilli));
    if (track.samples++ == 0 && !is_repeated_) {
      track.time_code_base = sample.time_code_millis - played_millis;
    }
    sample.counter = track.counter.Add(sample.counter);
    if (is_repeated_) sample.time_code_millis = track.time_code_base + played_millis;
    sample.stamp_nanos = last_played_;
    if (!track.decimator.Keeps(settings_.stream_hz, sample.counter, last_played_,
                               kClockStepNanos)) {
      return;
    }
    add_more(track, sample);
    Send(track, sample);
  }

  template <class Sample>
  void Send(Track& track, const Sample& sample) {
    const auto due = static_cast<std::int64_t>(static_cast<double>(last_played_) / settings_.speed);
    const bool describe =
        track.is_described &&
        (track.described_nanos < 0 || due - track.described_nanos >= kCharacterEveryNanos);
    if (describe) track.described_nanos = due;
    for (int copy = 0; copy < settings_.characters; ++copy) {
      const auto id = ids_.Find(sample.character, copy);
      if (!id) continue;
      if (describe) Describe(track.character, *id, copy, due);
      Sample copied = sample;
      copied.character = *id;
      copied.stamp_nanos = start_wall_ + due;
      if (copy > 0) MoveAside(copy * kSideBySide, copied);
      bool is_first = true;
      for (std::string& bytes : Encode(track, copied)) {
        out_->push_back({due, std::move(bytes), std::exchange(is_first, false)});
      }
    }
  }

  std::vector<std::string> Encode(const Track& track, const BodySample& sample) const {
    mvn::TypeSet types = types_;
    if (!is_subject_ && sample.has_tracker.none()) {
      types.reset(static_cast<std::size_t>(mvn::Type::kTrackers));
    }
    return mvn::EncodeSample(sample, types, track.landmarks);
  }
  std::vector<std::string> Encode(const Track&, const ObjectsSample& sample) const {
    return mvn::EncodeObjects(sample, types_);
  }

  void Describe(const Character& character, int id, int copy, std::int64_t due) {
    Character copied = character;
    copied.id = id;
    if (copy > 0 && !copied.name.empty()) copied.name += " " + std::to_string(copy + 1);
    for (std::string& bytes : mvn::EncodeCharacter(copied)) {
      const auto header = mvn::ParseHeader(bytes);
      if (!header || !mvn::Contains(types_, header->type)) continue;
      out_->push_back({due, std::move(bytes), false});
    }
  }

  void StartOver() {
    std::uint64_t most_samples = 0;
    for (auto& [id, track] : tracks_) {
      most_samples = std::max(most_samples, track.samples);
      track.samples = 0;
      track.counter.BeginRound();
    }
    const double rate = source_->nominal_rate_hz();
    const std::int64_t length = last_played_ - round_offset_;
    const std::int64_t steps = static_cast<std::int64_t>(most_samples) - 1;
    std::int64_t period = steps > 0 ? length / steps : 0;
    if (rate > 0) period = std::llround(1e9 / rate);
    round_offset_ = last_played_ + period;
    is_begun_ = false;
    is_repeated_ = true;
    source_ = Open();
  }

  const FeedSettings settings_;
  const mvn::TypeSet types_;
  const bool is_subject_;
  std::unique_ptr<Source> source_;
  CharacterIds ids_;
  const std::int64_t start_wall_;
  std::map<int, Track> tracks_;               // by the source's id
  std::vector<FeedDatagram>* out_ = nullptr;  // during Read
  bool types_are_checked_ = false;
  bool is_begun_ = false;         // this round
  bool is_repeated_ = false;      // not the first round
  std::int64_t first_stamp_ = 0;  // of this round
  std::int64_t round_offset_ = 0;
  std::int64_t last_played_ = 0;  // since the beginning, before speed
};

}  // namespace

std::unique_ptr<Feed> MakeSampleFeed(const FeedSettings& settings) {
  return std::make_unique<SampleFeed>(settings);
}

}  // namespace kinescope::app
