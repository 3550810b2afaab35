/// Injects network and sender faults into a stream of datagrams, reproducibly: the same seed and
/// the same input give the same output. It reads no clock: datagrams are added with the time at
/// which they are due and returned with the time at which to send them. So the same code runs in
/// tests in virtual time and in `kinescope stream` in real time. Times are ns since any fixed
/// instant.
///
/// Faults, and the base of each share:
///   loss       of datagrams: dropped
///   duplicate  of datagrams: the same bytes again, up to 3 places later
///   reorder    of datagrams: moved back by 1 to 3 places
///   jitter     of datagrams: delayed by up to 5 ms; later ones wait, the order is kept
///   burst      of time: everything due in such a tenth of a second is sent at once at its end
///   truncate   of datagrams: cut short anywhere, also to 0 bytes
///   corrupt    of datagrams: 1 to 4 random bytes changed
///   foreign    of datagrams: JSON, XML, other text or random bytes inserted before it
///   silence    of time: nothing is sent for a second
///   reset      of seconds: sample counter and time code of the character start over at 0
/// Shares of time are exact: a share of 0.05 is one burst in every 2 s, one silence in every 20 s,
/// one reset in every 20 s, each at a random place in its interval.
///
/// Loss, truncation, corruption and duplication exclude each other, in this order, so that each
/// datagram has at most one of them; times, order and resets are applied in addition. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/mvn/datagram.h"

namespace kinescope::mvn {

enum class Fault : std::uint8_t {
  kLoss,
  kDuplicate,
  kReorder,
  kJitter,
  kBurst,
  kTruncate,
  kCorrupt,
  kForeign,
  kSilence,
  kReset,
};
inline constexpr int kFaultCount = static_cast<int>(Fault::kReset) + 1;

/// "loss".
const char* Name(Fault fault);
/// The names of all faults, and "all".
std::vector<std::string> FaultNames();

struct FaultSettings {
  std::array<double, kFaultCount> share{};  // by Fault, 0 to 1
  double jitter_secs = 0.005;               // the longest delay
  double burst_secs = 0.1;                  // of one burst
  double silence_secs = 1;                  // of one silence

  double operator[](Fault fault) const { return share[static_cast<std::size_t>(fault)]; }
  double& operator[](Fault fault) { return share[static_cast<std::size_t>(fault)]; }
};

/// Applies one setting: "loss=0.05"; "jitter=0.05:0.02" with the seconds of a jitter, burst or
/// silence; "all=0.01" for every fault.
/// @throws UsageError with the fault, the value and the expected form.
void SetFault(std::string_view text, FaultSettings& settings);

struct FaultCount {
  std::uint64_t injected = 0;   // datagrams, bursts, silences, resets
  std::uint64_t datagrams = 0;  // affected datagrams: delayed by a burst, discarded by a silence
  // Of truncate and corrupt, whether ParseDatagram() rejects the result or takes it for valid.
  std::uint64_t detectable = 0;
  std::uint64_t undetectable = 0;
};

/// One fault applied to one datagram.
struct Injection {
  Fault fault = Fault::kLoss;
  std::optional<Header> header;   // header before the fault; none: not readable
  std::optional<Header> claimed;  // truncate, corrupt: header after the fault, if the datagram is
                                  // still accepted
  Reason rejected_for = Reason::kEmpty;  // truncate, corrupt, foreign: why ParseDatagram() rejects
                                         // it, if it does
};

struct TimedDatagram {
  std::int64_t send_nanos = 0;
  std::string bytes;
};

class FaultInjector {
 public:
  /// @pre shares and seconds are in the ranges that SetFault() accepts
  FaultInjector(const FaultSettings& settings, std::uint64_t seed);

  /// Called from Add() or Take() for every fault of one datagram.
  void set_listener(std::function<void(const Injection&)> listener) {
    listener_ = std::move(listener);
  }

  /// Adds the next datagram. @pre `due_nanos` never goes back
  void Add(std::string_view datagram, std::int64_t due_nanos);

  /// End of the input: datagrams that wait to be overtaken do not wait any longer.
  void End();

  /// When to send the next datagram; nullopt: there is none. A datagram that is added later may
  /// have to be sent first, so do not send beyond the due time of the next Add().
  std::optional<std::int64_t> next_send_nanos() const;

  /// The next datagram. Times never go back. @pre next_send_nanos() has a value
  TimedDatagram Take();

  const FaultCount& count(Fault fault) const { return counts_[Index(fault)]; }

 private:
  // Time windows: one at a random place in each of equally long cycles.
  struct Windows {
    std::int64_t cycle_start = 0;
    std::int64_t start = 0;   // of the window of this cycle
    bool is_counted = false;  // a datagram was in it
    bool is_begun = false;    // the first cycle has begun
  };

  // A queued datagram and the faults that will be applied to it.
  struct Waiting {
    TimedDatagram datagram;
    std::optional<Header> header;
    int put_back_by = 0;     // places still to move back; 0: stays in order
    int again_after = -1;    // datagrams until it is sent again; -1: it is sent once
    bool is_copy = false;    // the repetition
    std::int64_t until = 0;  // aside: send it at this time at the latest
    int passed_by = 0;       // aside: number of datagrams sent before it
  };

  // Sample counters of one character, for resets.
  struct Count {
    std::uint32_t newest = 0;  // as added
    std::uint32_t base = 0;    // the counter that is sent as 0
    std::uint32_t time_base = 0;
    std::uint32_t base_before = 0;  // for late datagrams of the sample before the reset
    std::uint32_t time_base_before = 0;
    std::int64_t cycle_start = 0;
    std::int64_t next_reset = 0;
  };

  static std::size_t Index(Fault fault) { return static_cast<std::size_t>(fault); }
  double Random(Fault fault);  // in [0, 1)
  int RandomInt(Fault fault, int low, int high);
  bool Happens(Fault fault) { return Random(fault) < settings_[fault]; }
  void Report(Fault fault, const std::optional<Header>& header);

  bool IsInWindow(Fault fault, double secs, Windows& windows, std::int64_t nanos);
  bool IsSwallowed(const std::optional<Header>& header, std::int64_t due_nanos);
  void Restart(std::string& datagram, Header& header, std::int64_t due_nanos);
  void ScheduleReset(Count& count);
  void Damage(Fault fault, Waiting& waiting);
  std::int64_t SendTime(const std::optional<Header>& header, std::int64_t due_nanos);
  void InsertForeign(std::int64_t send_nanos);
  void Enqueue(Waiting waiting);
  void SetAside();
  void LetPass(std::int64_t send_nanos, bool is_sent);
  Waiting TakeEarliest();
  void StopWaiting(std::int64_t now_nanos);
  void RepeatIfDue(const Waiting& sent);

  const FaultSettings settings_;
  std::array<std::mt19937_64, kFaultCount> engines_;  // one per fault, so that faults do not affect
                                                      // each other
  std::function<void(const Injection&)> listener_;
  std::array<FaultCount, kFaultCount> counts_{};

  std::optional<std::int64_t> first_due_;
  std::int64_t last_jittered_ = 0;  // of the datagram enqueued last
  std::int64_t last_send_ = 0;
  std::int64_t last_taken_ = 0;   // of the datagram taken last
  bool nothing_follows_ = false;  // currently no datagram may wait to be overtaken
  Windows bursts_;
  Windows silences_;
  std::map<int, Count> characters_;

  std::deque<Waiting> queue_;   // in order of sending
  std::vector<Waiting> aside_;  // taken out of order, to be overtaken
  std::deque<Waiting> ready_;   // overtaken by enough datagrams
};

}  // namespace kinescope::mvn
