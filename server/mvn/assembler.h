/// Joins the datagrams of a stream to samples: parts of a message, messages of a sample, several
/// characters and senders side by side. Feed it whatever comes; it never throws and never stops.
///
/// - A sample is all messages but 12 and 13 of equal (sender, character, sample counter). It is a
///   person's when it has the poses of all 23 segments: 02, or 21 and 22, or 01. A whole 02 of a
///   few things that are no body is a sample of tracked objects. Anything else is rejected.
/// - It is given on as soon as every type that this stream normally sends has come; else when the
///   next counter has overtaken it (has every type that it has); else 1.5 of the stream's own
///   periods after its first datagram. "Normally" is learnt, and follows when a type is switched on
///   or off. So a datagram may come a few places too late, also among those of the next sample.
/// - Samples of one character leave in the order of their counter. What comes for a sample already
///   given on is `late`, the same bytes once more are a `duplicate`.
/// - A header that contradicts the stream (its counter and time code do not go together, or its
///   place is taken) is believed when the next such one goes on from it: the sender has started
///   over, a `restart`. Else it is an `outlier`: damage on the way. Likewise nobody appears from a
///   single datagram of an unknown character.
/// - Types 12 and 13 make the Character; it is announced before its first sample and when it
///   changes.
/// - Stamps: see clock_fit.h.
///
/// A character's id in samples is the sender's own where it is free, else the next free one (two
/// senders that both send character 0). Who sends a character from another port of the same machine
/// is that sender, restarted, when the old port is silent, and somebody else when it is not; until
/// 0.1 s have told, the newcomer's datagrams are rejected. At most 16 (sender, character) pairs are
/// kept; beyond that one that has been silent for 3 s makes room, else the newcomer is rejected.
///
/// Time is an argument; one thread. Pose data allocate nothing.
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
#include "server/mvn/stamps.h"
#include "server/mvn/tally.h"

namespace kinescope::mvn {

class Assembler {
 public:
  explicit Assembler(Stamps stamps = Stamps::kFitted) : stamps_(stamps) {}
  Assembler(const Assembler&) = delete;  // streams point to the tally
  Assembler& operator=(const Assembler&) = delete;

  static constexpr std::size_t kMostStreams = 16;

  /// Takes one datagram that came from `sender` at `arrival`, not before the one before.
  void Add(const Endpoint& sender, std::string_view datagram, const Arrival& arrival,
           SampleSink& sink);

  /// Gives on what has waited long enough.
  void Expire(std::int64_t now_monotonic_nanos, SampleSink& sink);

  /// Nothing more will come: gives on whatever waits.
  void Flush(SampleSink& sink);

  /// When Expire() has something to do (monotonic); nullopt: nothing waits.
  std::optional<std::int64_t> deadline_nanos() const;

  SourceCounters counters() const { return tally_.ToCounters(); }
  const Tally& tally() const { return tally_; }

 private:
  struct Stream {
    Endpoint sender;
    int sent_character = 0;
    CharacterStream state;
  };

  // A newcomer of whom it is not yet known whether it replaces another.
  struct Trial {
    Endpoint sender;
    int sent_character = 0;
    std::int64_t since_nanos = 0;
  };

  tl::expected<Stream*, Reason> FindStream(const Endpoint& sender, int character, std::int64_t now,
                                           SampleSink& sink);
  bool IsOnTrial(const Endpoint& sender, int character, std::int64_t now);
  Stream* AddStream(const Endpoint& sender, int character, std::int64_t now, SampleSink& sink);
  int FreeId(int wanted) const;
  [[nodiscard]] bool MakeRoom(int wanted_id, std::int64_t now, SampleSink& sink);
  void DiscardUnconfirmed(std::int64_t now);

  Stamps stamps_;
  Tally tally_;
  std::vector<std::unique_ptr<Stream>> streams_;  // at most kMostStreams
  std::vector<Trial> trials_;                     // likewise
};

}  // namespace kinescope::mvn
