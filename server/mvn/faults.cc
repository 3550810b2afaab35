#include "server/mvn/faults.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/mvn/encode.h"

namespace kinescope::mvn {
namespace {

constexpr std::array<const char*, kFaultCount> kNames = {
    "loss",     "duplicate", "reorder", "jitter",  "burst",
    "truncate", "corrupt",   "foreign", "silence", "reset"};

constexpr double kNanos = 1e9;
constexpr int kMaxPlaces = 3;  // limit of places that a datagram is moved back
constexpr int kMaxCorruptBytes = 4;
constexpr std::int64_t kLongestAside = 50'000'000;  // a network does not keep a packet for longer
constexpr double kMinBetweenResets = 1.0;           // s: a recording is not shorter
constexpr std::int32_t kSourceRestart = 1000;       // a counter this far back is a restart
constexpr double kLongestSecs = 60;

std::string AllNames() {
  std::string all;
  for (const std::string& name : FaultNames()) all += (all.empty() ? "" : ", ") + name;
  return all;
}

double ParseNumber(std::string_view text, double low, double high, const std::string& error) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(value >= low && value <= high)) {
    throw UsageError(error);
  }
  return value;
}

double* SecsOf(Fault fault, FaultSettings& settings) {
  switch (fault) {
    case Fault::kJitter: return &settings.jitter_secs;
    case Fault::kBurst: return &settings.burst_secs;
    case Fault::kSilence: return &settings.silence_secs;
    default: return nullptr;
  }
}

std::int64_t ToNanos(double secs) { return std::llround(secs * kNanos); }

}  // namespace

std::vector<std::string> FaultNames() {
  std::vector<std::string> names(kNames.begin(), kNames.end());
  names.emplace_back("all");
  return names;
}

const char* Name(Fault fault) { return kNames[static_cast<std::size_t>(fault)]; }

void SetFault(std::string_view text, FaultSettings& settings) {
  const std::string flag = "'" + std::string(text) + "': ";
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw UsageError(flag + "expected FAULT=SHARE, such as loss=0.05");
  }
  const std::string_view name = text.substr(0, equals);
  const std::size_t colon = std::min(text.find(':', equals), text.size());
  const double share = ParseNumber(text.substr(equals + 1, colon - equals - 1), 0, 1,
                                   flag + "expected a share from 0 to 1 after '='");
  if (name == "all" && colon == text.size()) return settings.share.fill(share);
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw UsageError(flag + (name == "all" ? "only jitter, burst and silence take seconds"
                                           : "unknown fault; expected one of " + AllNames()));
  }
  const auto fault = static_cast<Fault>(found - kNames.begin());
  settings[fault] = share;
  if (colon == text.size()) return;
  double* const secs = SecsOf(fault, settings);
  if (secs == nullptr) throw UsageError(flag + "only jitter, burst and silence take seconds");
  *secs = ParseNumber(text.substr(colon + 1), 0.001, kLongestSecs,
                      flag + "expected 0.001 to 60 seconds after ':'");
}

FaultInjector::FaultInjector(const FaultSettings& settings, std::uint64_t seed)
    : settings_(settings) {
  for (std::size_t i = 0; i < engines_.size(); ++i) {
    KINESCOPE_CHECK(settings_.share[i] >= 0 && settings_.share[i] <= 1);
    std::seed_seq mixed = {static_cast<std::uint32_t>(seed),
                           static_cast<std::uint32_t>(seed >> 32U), static_cast<std::uint32_t>(i)};
    engines_[i].seed(mixed);
  }
  for (const double secs : {settings_.jitter_secs, settings_.burst_secs, settings_.silence_secs}) {
    KINESCOPE_CHECK(secs > 0 && secs <= kLongestSecs);
  }
}

double FaultInjector::Random(Fault fault) {
  // Not a standard distribution, because their results differ between libraries.
  return static_cast<double>(engines_[Index(fault)]() >> 11U) * 0x1p-53;
}

int FaultInjector::RandomInt(Fault fault, int low, int high) {
  return low + static_cast<int>(Random(fault) * (high - low + 1));
}

void FaultInjector::Report(Fault fault, const std::optional<Header>& header) {
  ++counts_[Index(fault)].datagrams;
  if (listener_) listener_({fault, header, std::nullopt, Reason::kEmpty});
}

// Whether `nanos` is in a window of `fault`. @pre `nanos` never goes back
bool FaultInjector::IsInWindow(Fault fault, double secs, Windows& windows, std::int64_t nanos) {
  if (settings_[fault] == 0) return false;
  const std::int64_t length = ToNanos(secs);
  const std::int64_t cycle = ToNanos(secs / settings_[fault]);
  const auto begin_cycle = [&](std::int64_t start) {
    const double room = static_cast<double>(cycle - length);
    windows = {start, start + static_cast<std::int64_t>(Random(fault) * room), false, true};
  };
  if (!windows.is_begun) begin_cycle(*first_due_);
  while (nanos >= windows.cycle_start + cycle) begin_cycle(windows.cycle_start + cycle);
  if (nanos < windows.start || nanos >= windows.start + length) return false;
  if (!std::exchange(windows.is_counted, true)) ++counts_[Index(fault)].injected;
  return true;
}

bool FaultInjector::IsSwallowed(const std::optional<Header>& header, std::int64_t due_nanos) {
  nothing_follows_ = IsInWindow(Fault::kSilence, settings_.silence_secs, silences_, due_nanos);
  if (!nothing_follows_) return false;
  StopWaiting(due_nanos);
  Report(Fault::kSilence, header);
  return true;
}

void FaultInjector::ScheduleReset(Count& count) {
  const double cycle = 1 / settings_[Fault::kReset];
  const double least = std::min(kMinBetweenResets, cycle / 2);
  count.next_reset = count.cycle_start + ToNanos(least + Random(Fault::kReset) * (cycle - least));
  count.cycle_start += ToNanos(cycle);
}

// Makes the counter relative to the character's last reset, and resets it with the first datagram
// of a sample.
void FaultInjector::Restart(std::string& datagram, Header& header, std::int64_t due_nanos) {
  if (settings_[Fault::kReset] == 0 || !BelongsToSample(header.type)) return;
  const std::uint32_t counter = header.sample_counter;
  const auto [entry, is_new] = characters_.try_emplace(header.character);
  Count& count = entry->second;
  if (is_new) {
    count.newest = counter;
    count.cycle_start = *first_due_;
    ScheduleReset(count);
  }
  const auto ahead = static_cast<std::int32_t>(counter - count.newest);
  if (ahead < -kSourceRestart) {
    count.base = count.time_base = count.base_before = count.time_base_before = 0;
  }
  bool has_reset = false;
  if (ahead > 0 || ahead < -kSourceRestart) {
    count.newest = counter;
    if (due_nanos >= count.next_reset) {
      count.base_before = std::exchange(count.base, counter);
      count.time_base_before = std::exchange(count.time_base, header.time_code_millis);
      while (due_nanos >= count.next_reset) ScheduleReset(count);
      has_reset = true;
    }
  }
  const bool is_before = static_cast<std::int32_t>(counter - count.base) < 0;
  header.sample_counter -= is_before ? count.base_before : count.base;
  header.time_code_millis -= is_before ? count.time_base_before : count.time_base;
  PatchHeader({std::nullopt, header.sample_counter, header.time_code_millis}, datagram);
  if (!has_reset) return;
  ++counts_[Index(Fault::kReset)].injected;
  Report(Fault::kReset, header);
}

void FaultInjector::Damage(Fault fault, Waiting& waiting) {
  std::string& bytes = waiting.datagram.bytes;
  const int size = static_cast<int>(bytes.size());
  if (size == 0) return;
  if (fault == Fault::kTruncate) {
    bytes.resize(static_cast<std::size_t>(RandomInt(fault, 0, size - 1)));
  } else {
    const std::string whole = bytes;
    for (int left = RandomInt(fault, 1, kMaxCorruptBytes); left > 0; --left) {
      const auto at = static_cast<std::size_t>(RandomInt(fault, 0, size - 1));
      if (bytes[at] != whole[at]) continue;  // this byte is already changed
      bytes[at] = static_cast<char>(static_cast<std::uint8_t>(bytes[at]) ^
                                    static_cast<std::uint8_t>(RandomInt(fault, 1, 255)));
    }
  }
  FaultCount& count = counts_[Index(fault)];
  ++count.injected;
  ++count.datagrams;
  Injection injection{fault, waiting.header, std::nullopt, Reason::kEmpty};
  if (const auto parsed = ParseDatagram(bytes)) {
    ++count.undetectable;
    injection.claimed = parsed->header;
  } else {
    ++count.detectable;
    injection.rejected_for = parsed.error().reason;
  }
  if (listener_) listener_(injection);
}

// The send time after jitter and bursts.
std::int64_t FaultInjector::SendTime(const std::optional<Header>& header, std::int64_t due_nanos) {
  std::int64_t delay = 0;
  if (Happens(Fault::kJitter)) {
    delay = ToNanos(Random(Fault::kJitter) * settings_.jitter_secs);
    ++counts_[Index(Fault::kJitter)].injected;
    Report(Fault::kJitter, header);
  }
  last_jittered_ = std::max(due_nanos + delay, last_jittered_);
  // Uses the due time, so that a burst does not separate datagrams that belong together.
  if (!IsInWindow(Fault::kBurst, settings_.burst_secs, bursts_, due_nanos)) return last_jittered_;
  StopWaiting(due_nanos);
  Report(Fault::kBurst, header);
  return std::max(last_jittered_, bursts_.start + ToNanos(settings_.burst_secs));
}

void FaultInjector::InsertForeign(std::int64_t send_nanos) {
  std::string bytes;
  const std::string number = std::to_string(RandomInt(Fault::kForeign, 0, 999));
  switch (RandomInt(Fault::kForeign, 0, 3)) {
    case 0: bytes = R"({"type":"transport","value":)" + number + "}"; break;
    case 1: bytes = R"(<?xml version="1.0"?><CaptureName Take=")" + number + R"("/>)"; break;
    case 2: bytes = "take " + number + ": recording\r\n"; break;
    default:
      bytes.push_back('\xFF');  // neither text nor "M"
      for (int left = RandomInt(Fault::kForeign, 1, 1400); left > 0; --left) {
        bytes.push_back(static_cast<char>(RandomInt(Fault::kForeign, 0, 255)));
      }
  }
  FaultCount& count = counts_[Index(Fault::kForeign)];
  ++count.injected;
  ++count.datagrams;
  const auto parsed = ParseDatagram(bytes);
  KINESCOPE_CHECK(!parsed);
  if (listener_) {
    listener_({Fault::kForeign, std::nullopt, std::nullopt, parsed.error().reason});
  }
  Waiting waiting;
  waiting.datagram = {send_nanos, std::move(bytes)};
  Enqueue(std::move(waiting));
}

void FaultInjector::Add(std::string_view datagram, std::int64_t due_nanos) {
  if (!first_due_) first_due_ = last_jittered_ = last_send_ = last_taken_ = due_nanos;
  Waiting waiting;
  waiting.datagram.bytes = datagram;
  if (const auto header = ParseHeader(datagram)) waiting.header = *header;
  if (waiting.header) Restart(waiting.datagram.bytes, *waiting.header, due_nanos);
  if (IsSwallowed(waiting.header, due_nanos)) return;
  // Random numbers are drawn for every datagram, so that the faults of one do not affect the
  // others.
  const bool is_lost = Happens(Fault::kLoss);
  const bool is_cut = Happens(Fault::kTruncate);
  const bool is_corrupt = Happens(Fault::kCorrupt);
  const bool comes_again = Happens(Fault::kDuplicate);
  const bool is_reordered = Happens(Fault::kReorder);
  const bool follows_foreign = Happens(Fault::kForeign);
  if (is_lost) {
    ++counts_[Index(Fault::kLoss)].injected;
    return Report(Fault::kLoss, waiting.header);
  }
  waiting.datagram.send_nanos = SendTime(waiting.header, due_nanos);
  if (is_cut || is_corrupt) {
    Damage(is_cut ? Fault::kTruncate : Fault::kCorrupt, waiting);
  } else if (comes_again) {
    waiting.again_after = RandomInt(Fault::kDuplicate, 0, kMaxPlaces);
  }
  if (is_reordered) waiting.put_back_by = RandomInt(Fault::kReorder, 1, kMaxPlaces);
  if (follows_foreign) InsertForeign(waiting.datagram.send_nanos);
  Enqueue(std::move(waiting));
}

void FaultInjector::Enqueue(Waiting waiting) {
  last_send_ = std::max(waiting.datagram.send_nanos, last_send_);
  waiting.datagram.send_nanos = last_send_;
  queue_.push_back(std::move(waiting));
  SetAside();
}

// Sets aside the datagrams that others should overtake.
void FaultInjector::SetAside() {
  while (!queue_.empty() && queue_.front().put_back_by > 0) {
    Waiting waiting = std::move(queue_.front());
    queue_.pop_front();
    const std::int64_t now = waiting.datagram.send_nanos;
    LetPass(now, false);
    waiting.until = now + (nothing_follows_ ? 0 : kLongestAside);
    aside_.push_back(std::move(waiting));
  }
}

// No datagram will overtake those that are aside, for now.
void FaultInjector::StopWaiting(std::int64_t now_nanos) {
  for (Waiting& waiting : aside_) {
    waiting.until = std::min(waiting.until, std::max(now_nanos, waiting.datagram.send_nanos));
  }
}

void FaultInjector::End() {
  nothing_follows_ = true;
  StopWaiting(last_taken_);
}

std::optional<std::int64_t> FaultInjector::next_send_nanos() const {
  std::optional<std::int64_t> next;
  const auto consider = [&](std::int64_t nanos) {
    nanos = std::max(nanos, last_taken_);
    next = next ? std::min(*next, nanos) : nanos;
  };
  if (!ready_.empty()) consider(ready_.front().datagram.send_nanos);
  if (!queue_.empty()) consider(queue_.front().datagram.send_nanos);
  for (const Waiting& waiting : aside_) consider(waiting.until);
  return next;
}

// One more datagram has passed; `is_sent`: it was not set aside.
void FaultInjector::LetPass(std::int64_t send_nanos, bool is_sent) {
  for (std::size_t i = 0; i < aside_.size();) {
    const bool is_gone_before = aside_[i].until < send_nanos;  // its time limit is over
    aside_[i].passed_by += is_sent ? 1 : 0;
    if (is_gone_before || --aside_[i].put_back_by > 0) {
      ++i;
      continue;
    }
    aside_[i].datagram.send_nanos = send_nanos;
    ready_.push_back(std::move(aside_[i]));
    aside_.erase(aside_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void FaultInjector::RepeatIfDue(const Waiting& sent) {
  if (sent.again_after < 0) return;
  ++counts_[Index(Fault::kDuplicate)].injected;
  Report(Fault::kDuplicate, sent.header);
  Waiting copy = sent;
  copy.again_after = -1;
  copy.is_copy = true;
  copy.passed_by = 0;
  copy.put_back_by = sent.again_after;
  copy.until = sent.datagram.send_nanos + (nothing_follows_ ? 0 : kLongestAside);
  if (copy.put_back_by == 0) {
    ready_.push_back(std::move(copy));
  } else {
    aside_.push_back(std::move(copy));
  }
}

FaultInjector::Waiting FaultInjector::TakeEarliest() {
  const auto is_earlier = [](const Waiting& a, const Waiting& b) { return a.until < b.until; };
  const auto overdue = std::min_element(aside_.begin(), aside_.end(), is_earlier);
  std::deque<Waiting>& in_order = ready_.empty() ? queue_ : ready_;
  Waiting taken;
  if (in_order.empty() ||
      (overdue != aside_.end() && overdue->until < in_order.front().datagram.send_nanos)) {
    KINESCOPE_CHECK(overdue != aside_.end());
    taken = std::move(*overdue);
    taken.datagram.send_nanos = taken.until;
    aside_.erase(overdue);
  } else {
    taken = std::move(in_order.front());
    in_order.pop_front();
  }
  return taken;
}

TimedDatagram FaultInjector::Take() {
  Waiting sent = TakeEarliest();
  if (sent.passed_by > 0 && !sent.is_copy) {
    ++counts_[Index(Fault::kReorder)].injected;
    Report(Fault::kReorder, sent.header);
  }
  last_taken_ = sent.datagram.send_nanos = std::max(sent.datagram.send_nanos, last_taken_);
  LetPass(last_taken_, true);
  RepeatIfDue(sent);
  SetAside();
  return std::move(sent.datagram);
}

}  // namespace kinescope::mvn
