/// Damages a stream of datagrams as networks and senders do, on purpose, repeatably: the same seed
/// and the same input give the same output. Knows no clock: datagrams come with the time at which
/// they are due and leave with the time at which to send them, so that the same code runs in tests
/// in virtual time and in `kinescope stream` in real time. Times are nanoseconds since anything.
///
/// Faults, and what their share is a share of:
///   loss       of datagrams: gone
///   duplicate  of datagrams: the same bytes again, up to 3 places later
///   reorder    of datagrams: put back by 1 to 3 places
///   jitter     of datagrams: delayed by up to 5 ms; those after it wait, order is kept
///   burst      of time: what is due in such a tenth of a second is sent at once at its end
///   truncate   of datagrams: cut short anywhere, also to nothing
///   corrupt    of datagrams: 1 to 4 random bytes changed
///   foreign    of datagrams: JSON, XML, other text or random bytes inserted before it
///   silence    of time: nothing is sent for a second
///   reset      of seconds: the character's sample counter and time code start over at 0
/// Shares of time are kept exactly: a share of 0.05 is one burst in every 2 s, one silence in every
/// 20 s, one reset in every 20 s, at a random place therein.
///
/// Loss, truncation, corruption and duplication exclude each other, in this order, so that each
/// datagram has one fate; times, order and resets go on top. One thread.
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

struct FaultSettings {
  std::array<double, kFaultCount> share{};  // by Fault, 0 to 1
  double jitter_secs = 0.005;               // the longest delay
  double burst_secs = 0.1;                  // of one burst
  double silence_secs = 1;                  // of one silence

  double operator[](Fault fault) const { return share[static_cast<std::size_t>(fault)]; }
  double& operator[](Fault fault) { return share[static_cast<std::size_t>(fault)]; }
};

/// Sets what `text` says: "loss=0.05"; "jitter=0.05:0.02" with the seconds of a jitter, burst or
/// silence; "all=0.01" for every fault.
/// @throws UsageError naming the fault, the value and what would be right.
void SetFault(std::string_view text, FaultSettings& settings);

struct FaultCount {
  std::uint64_t injected = 0;   // datagrams, bursts, silences, resets
  std::uint64_t datagrams = 0;  // that it was done to: held back by a burst, swallowed by a silence
  std::uint64_t refused = 0;    // truncate, corrupt: ParseDatagram() refuses what is left
  std::uint64_t silent = 0;     // likewise, it does not: nobody can tell
};

/// One fault done to one datagram, told as it happens.
struct Injection {
  Fault fault = Fault::kLoss;
  std::optional<Header> header;   // as it would have been sent; none: it had no readable one
  std::optional<Header> claimed;  // truncate, corrupt: what a reader takes it for, if it is taken
  Reason refused_for = Reason::kEmpty;  // truncate, corrupt, foreign: why, where it is refused
};

struct TimedDatagram {
  std::int64_t send_nanos = 0;
  std::string bytes;
};

class FaultInjector {
 public:
  /// @pre shares and seconds are in the ranges that SetFault() takes
  FaultInjector(const FaultSettings& settings, std::uint64_t seed);

  /// Called for every fault of one datagram, from Add() or Take().
  void set_listener(std::function<void(const Injection&)> listener) {
    listener_ = std::move(listener);
  }

  /// Takes the next datagram. @pre `due_nanos` is not before that of the one before
  void Add(std::string_view datagram, std::int64_t due_nanos);

  /// Nothing more comes: what waits for others to pass it need not wait any longer.
  void End();

  /// When the next datagram is to be sent; nullopt: there is none. A datagram that is added later
  /// may have to go before it, so send nothing that is due later than what is still to be added.
  std::optional<std::int64_t> next_send_nanos() const;

  /// The next datagram. Times never go back. @pre next_send_nanos() has a value
  TimedDatagram Take();

  const FaultCount& count(Fault fault) const { return counts_[Index(fault)]; }

 private:
  // Windows of time, one somewhere in each of equally long cycles.
  struct Windows {
    std::int64_t cycle_start = 0;
    std::int64_t start = 0;   // of the window of this cycle
    bool is_counted = false;  // something fell into it
    bool is_begun = false;    // there is a cycle at all
  };

  // A datagram on its way, and what will happen to it when its turn comes.
  struct Waiting {
    TimedDatagram datagram;
    std::optional<Header> header;
    int put_back_by = 0;     // places still to go; 0: it stays in order
    int again_after = -1;    // -1: it is sent once
    bool is_copy = false;    // the second time
    std::int64_t until = 0;  // aside: no longer than this
    int passed_by = 0;       // aside: so many were sent first
  };

  // Sample counters of one character, for resets.
  struct Count {
    std::uint32_t newest = 0;  // as it came
    std::uint32_t base = 0;    // what is sent as 0
    std::uint32_t time_base = 0;
    std::uint32_t base_before = 0;  // for the sample before the reset, where it comes later
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
  std::array<std::mt19937_64, kFaultCount> engines_;  // one each: no fault shifts another
  std::function<void(const Injection&)> listener_;
  std::array<FaultCount, kFaultCount> counts_{};

  std::optional<std::int64_t> first_due_;
  std::int64_t last_jittered_ = 0;  // the times of what was enqueued last and
  std::int64_t last_send_ = 0;
  std::int64_t last_taken_ = 0;   // of what was taken last
  bool nothing_follows_ = false;  // for now: nothing may wait to be passed
  Windows bursts_;
  Windows silences_;
  std::map<int, Count> characters_;

  std::deque<Waiting> queue_;   // in order of sending
  std::vector<Waiting> aside_;  // taken out of order, to be passed by others
  std::deque<Waiting> ready_;   // passed by enough of them
};

}  // namespace kinescope::mvn
