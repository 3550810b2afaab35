/// Assembles the datagrams of a stream to samples: parts of a message, messages of a sample,
/// several characters and senders side by side. It accepts any datagrams; it never throws and never
/// stops.
///
/// - A sample consists of all messages except 12 and 13 with equal (sender, character, sample
///   counter). It is the sample of a person if it has the poses of all 23 segments: 02, or 21 and
///   22, or 01. A complete 02 of a few segments that are not a body is a sample of tracked objects.
///   Anything else is rejected.
/// - It is delivered as soon as it has every type that this stream normally sends. Otherwise it is
///   delivered when the next counter has every type that it has, or when it has waited as long as
///   Delivery says. The normal types are learnt, and follow when a type is switched on or off. So a
///   datagram may arrive a few places late, also among those of the next sample.
/// - Samples of one character are delivered in the order of their counter. A datagram for a
///   delivered sample is `late`, repeated bytes are a `duplicate`.
/// - A header may contradict the stream: its counter and time code do not match, or its place is
///   taken. It is accepted if the next such header continues it: the sender has started over, a
///   `restart`. Otherwise it is an `outlier`: corruption. For the same reason a single datagram of
///   an unknown character does not make a new character.
/// - Types 12 and 13 make the Character. It is delivered before its first sample and after each
///   change.
/// - Stamps: see clock_fit.h.
///
/// The character's id in samples is the sender's own where it is free, else the next free one (two
/// senders may both send character 0). Datagrams of the same character from another port of the
/// same machine count as the restarted sender if the old port is silent, otherwise as a new sender.
/// Until 0.1 s have decided which, they are rejected. At most 16 (sender, character) pairs are
/// kept. Beyond that a pair that has been silent for 3 s is replaced, or one that must give way to
/// a newcomer that asks a second time (giving_way.h). Without one, the new pair is rejected.
///
/// Time is an argument, so that tests need no clock. One thread. Pose data cause no allocation.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "core/source.h"
#include "server/mvn/arrival.h"
#include "server/mvn/character_stream.h"
#include "server/mvn/datagram.h"
#include "server/mvn/endpoint.h"
#include "server/mvn/stream_settings.h"
#include "server/mvn/tally.h"

namespace kinescope::mvn {

class Assembler {
 public:
  explicit Assembler(StreamSettings settings = {}) : settings_(settings) {}
  Assembler(const Assembler&) = delete;  // streams point to the tally
  Assembler& operator=(const Assembler&) = delete;

  static constexpr std::size_t kMaxStreams = 16;

  /// Adds one datagram that `sender` sent and that arrived at `arrival`. Arrivals never go back.
  void Add(const Endpoint& sender, std::string_view datagram, const Arrival& arrival,
           SampleSink& sink);

  /// Delivers the samples whose waiting time is over.
  void Expire(std::int64_t now_monotonic_nanos, SampleSink& sink);

  /// End of the stream: delivers all samples that wait.
  void Flush(SampleSink& sink);

  /// When Expire() must be called next (monotonic clock, ns); nullopt: no sample waits.
  std::optional<std::int64_t> deadline_nanos() const;

  SourceCounters counters() const { return tally_.ToCounters(); }
  const Tally& tally() const { return tally_; }

 private:
  struct Stream {
    Endpoint sender;
    int sent_character = 0;
    std::int64_t since_nanos = 0;
    CharacterStream state;
  };

  // A new sender while it is undecided whether it replaces another.
  struct Trial {
    Endpoint sender;
    int sent_character = 0;
    std::int64_t since_nanos = 0;
  };

  // A sender that is not known yet.
  struct Newcomer {
    const Endpoint& sender;
    int character = 0;
    bool has_whole_body = false;  // in its first datagram
    std::int64_t now = 0;
  };

  tl::expected<Stream*, Reason> FindStream(const Newcomer& newcomer, SampleSink& sink);
  bool IsOnTrial(const Endpoint& sender, int character, std::int64_t now);
  Stream* AddStream(const Newcomer& newcomer, SampleSink& sink);
  int FreeId(int wanted) const;
  [[nodiscard]] bool MakeRoom(const Newcomer& newcomer, SampleSink& sink);
  using Streams = std::vector<std::unique_ptr<Stream>>;
  Streams::iterator VictimOf(const Newcomer& newcomer);

  // A sender that was turned away because all places are taken.
  struct Knock {
    Endpoint sender;
    int character = 0;
    bool operator==(const Knock& other) const {
      return sender == other.sender && character == other.character;
    }
  };
  static constexpr std::size_t kMaxKnocks = 1024;
  bool HasKnocked(const Newcomer& newcomer);
  void DiscardUnconfirmed(std::int64_t now);

  StreamSettings settings_;
  Tally tally_;
  Streams streams_;            // at most kMaxStreams, the oldest first
  std::vector<Trial> trials_;  // at most kMaxStreams
  std::vector<Knock> knocks_;  // the latest, a ring
  std::size_t next_knock_ = 0;
};

}  // namespace kinescope::mvn
