/// Assembles the messages of one character from one sender to samples. See assembler.h for the
/// rules. One thread. Times are on the monotonic clock, ns.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/source.h"
#include "server/mvn/arrival.h"
#include "server/mvn/clock_fit.h"
#include "server/mvn/closed_samples.h"
#include "server/mvn/learnt_types.h"
#include "server/mvn/loss_meter.h"
#include "server/mvn/pending_sample.h"
#include "server/mvn/scale_group.h"
#include "server/mvn/stream_line.h"
#include "server/mvn/stream_settings.h"
#include "server/mvn/tally.h"

namespace kinescope::mvn {

class CharacterStream {
 public:
  /// `id`: for samples and character; `tally` must outlive this object.
  CharacterStream(int id, StreamSettings settings, Tally& tally)
      : tally_(&tally), settings_(settings) {
    character_.id = id;
  }

  int id() const { return character_.id; }
  std::int64_t last_heard_nanos() const { return last_heard_nanos_; }
  /// A second datagram has confirmed that the first was not a corrupt header. Nothing is delivered
  /// before.
  bool is_confirmed() const { return is_confirmed_; }
  /// When the newest delivered sample was received; long ago without any.
  std::int64_t last_given_nanos() const { return last_given_nanos_; }

  /// `digest` identifies the datagram's bytes. The datagram ends in a sample, a character or the
  /// tally.
  void Add(const Message& message, std::uint32_t digest, const Arrival& arrival, SampleSink& sink);

  /// Delivers the samples whose waiting time is over at `now_nanos`.
  void Expire(std::int64_t now_nanos, SampleSink& sink);
  /// When Expire() must be called next; nullopt: no sample waits.
  std::optional<std::int64_t> deadline_nanos() const;

  /// The sender was restarted: counters and clock start over, the person stays.
  void SenderRestarted(SampleSink& sink);

  /// End of the stream: delivers all samples that wait.
  void Flush(SampleSink& sink);

  /// Counts the datagrams of a character that was never confirmed as outliers.
  void Discard();

 private:
  static constexpr std::size_t kMaxOpen = 4;

  struct OpenSample {
    bool is_open = false;
    PendingSample sample;
  };

  // A datagram that does not fit the stream: corrupt, or the first after a restart. Kept until the
  // next one decides.
  struct Doubtful {
    Message message;
    std::uint32_t digest = 0;
    Arrival arrival;
    int fitted_since = 0;  // later datagrams that continued the stream
  };

  enum class Place { kFits, kDuplicate, kLate, kDoubtful, kRestart };

  void AddToSample(const Message& message, std::uint32_t digest, const Arrival& arrival,
                   SampleSink& sink);
  Place PlaceOf(const Header& header, SampleType type, std::uint32_t digest,
                std::int64_t now) const;
  Place PlaceBehind(const Header& header, SampleType type, std::uint32_t digest,
                    std::int64_t now) const;
  void Accept(const Message& message, std::uint32_t digest, const Arrival& arrival,
              SampleSink& sink);
  void Doubt(const Message& message, std::uint32_t digest, const Arrival& arrival,
             SampleSink& sink);
  std::int32_t PlausibleStep() const;
  bool GoesOnFrom(const Header& first, const Header& next) const;
  bool IsRestartByRun(std::uint32_t counter);
  void DropDoubtful();
  void Restart(SampleSink& sink);

  OpenSample* Find(std::uint32_t counter);
  const OpenSample* Find(std::uint32_t counter) const;
  OpenSample& Open(const Message& message, const Arrival& arrival, SampleSink& sink);
  OpenSample* Oldest();
  void FinishUpTo(std::uint32_t counter, SampleSink& sink);
  void FinishOvertakenBy(const PendingSample& newer, SampleSink& sink);
  void FinishAll(SampleSink& sink);
  void Finish(OpenSample& open, SampleSink& sink);
  void MeasurePeriod(std::uint32_t time_code_millis, std::int64_t now);
  std::int64_t StampOf(const PendingSample& sample);
  std::int64_t PatienceNanos() const;

  void AddMetaData(const MetaDataMessage& body, SampleSink& sink);
  void AddScale(const Message& message, std::int64_t now_nanos, SampleSink& sink);
  void TakeScale(std::int64_t now_nanos, SampleSink& sink);
  void Announce(SampleSink& sink);
  void AnnounceOnce(SampleSink& sink);

  Tally* tally_;
  StreamSettings settings_;
  Character character_;
  bool wants_announcement_ = true;
  ScaleGroup scale_;
  std::int64_t last_heard_nanos_ = 0;
  bool is_heard_ = false;  // a first datagram was received
  bool is_confirmed_ = false;

  std::array<OpenSample, kMaxOpen> open_;
  std::uint32_t run_start_ = 0;          // counter of the first sample since the last restart
  std::optional<std::uint32_t> newest_;  // largest counter of a sample so far
  std::optional<std::uint32_t> closed_;  // samples up to this counter are not delivered any more
  std::int64_t newest_heard_nanos_ = 0;  // receive time of the newest datagram of an open sample
  ClosedSamples history_;
  TimeCodeLine line_;
  StepMeter steps_;
  LossMeter losses_;
  std::optional<Doubtful> doubtful_;
  std::uint32_t repeated_counter_ = 0;  // largest counter in a series of late and repeated ones
  int repeated_length_ = 0;
  ClockFit clock_;

  LearntTypes types_;
  bool has_given_ = false;  // a sample was delivered
  std::int64_t last_given_nanos_ = std::numeric_limits<std::int64_t>::min() / 2;
  std::optional<double> period_nanos_;  // running mean
  struct Begun {
    std::uint32_t time_code_millis = 0;
    std::int64_t arrival_nanos = 0;
  };
  std::optional<Begun> last_begin_;
};

}  // namespace kinescope::mvn
