#include "server/app/stream/stream_transmission.h"

#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/stop_signal.h"

namespace kinescope::app {
namespace {

// A signal that comes between looking and sleeping is seen this much later.
constexpr std::int64_t kLongestSleep = 50'000'000;

}  // namespace

void Transmission::Run(double seconds) {
  // The kernel may wake a thread 50 us late to save power; a suit's samples are 4 ms apart.
  prctl(PR_SET_TIMERSLACK, 1000);
  start_nanos_ = MonotonicNanos();
  const std::int64_t end = seconds > 0 ? static_cast<std::int64_t>(seconds * 1e9)
                                       : std::numeric_limits<std::int64_t>::max();
  if (feed_.is_live()) {
    RunLive(end);
  } else {
    RunPaced(end);
  }
  Drain();
}

std::int64_t Transmission::Now() const { return MonotonicNanos() - start_nanos_; }

// False when the program is to stop.
bool Transmission::SleepUntil(std::int64_t nanos) const {
  while (!StopRequested()) {
    const std::int64_t now = Now();
    if (now >= nanos) return true;
    const std::int64_t wake = start_nanos_ + std::min(nanos, now + kLongestSleep);
    timespec deadline{};
    deadline.tv_sec = wake / kNanosPerSecond;
    deadline.tv_nsec = wake % kNanosPerSecond;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
  }
  return false;
}

void Transmission::RunPaced(std::int64_t end_nanos) {
  std::vector<FeedDatagram> next;
  while (true) {
    next.clear();
    const Feed::State state = feed_.Read(std::chrono::nanoseconds(0), next);
    for (const FeedDatagram& datagram : next) {
      if (datagram.due_nanos >= end_nanos) return;
      // What faults have held back until before this one goes first, each at its own time.
      while (const auto held = faults_.next_send_nanos()) {
        if (*held >= datagram.due_nanos) break;
        if (!SleepUntil(*held)) return;
        SendNext();
      }
      if (!SleepUntil(datagram.due_nanos)) return;
      Admit(datagram);
    }
    if (state == Feed::State::kEnded || StopRequested()) return;
  }
}

void Transmission::RunLive(std::int64_t end_nanos) {
  std::vector<FeedDatagram> came;
  while (!StopRequested() && Now() < end_nanos) {
    came.clear();
    const std::int64_t now = Now();
    std::int64_t wake = std::min(now + kLongestSleep, end_nanos);
    if (const auto held = faults_.next_send_nanos()) wake = std::clamp(*held, now, wake);
    const Feed::State state = feed_.Read(std::chrono::nanoseconds(wake - now), came);
    for (const FeedDatagram& datagram : came) {
      SendBefore(datagram.due_nanos);
      Admit(datagram);
    }
    SendBefore(Now());
    if (state == Feed::State::kEnded) return;
  }
}

// A user who stops the program does not want to wait.
void Transmission::Drain() {
  faults_.End();
  while (const auto held = faults_.next_send_nanos()) {
    SleepUntil(*held);
    SendNext();
  }
}

void Transmission::Admit(const FeedDatagram& datagram) {
  if (datagram.begins_sample) {
    ++samples_;
    progress_.Step();
  }
  faults_.Add(datagram.bytes, datagram.due_nanos);
  SendBefore(datagram.due_nanos + 1);
}

void Transmission::SendBefore(std::int64_t nanos) {
  while (faults_.next_send_nanos().value_or(nanos) < nanos) SendNext();
}

void Transmission::SendNext() {
  const std::string datagram = faults_.Take().bytes;
  sender_.Send(datagram);
  ++datagrams_;
  bytes_ += datagram.size();
  if (const auto header = mvn::ParseHeader(datagram)) {
    ++by_type_[static_cast<std::size_t>(header->type)];
  } else {
    ++other_;
  }
}

std::map<std::string, std::uint64_t> Transmission::types() const {
  std::map<std::string, std::uint64_t> types;
  for (std::size_t i = 0; i < by_type_.size(); ++i) {
    if (by_type_[i] > 0) types[mvn::TypeDigits(static_cast<mvn::Type>(i))] = by_type_[i];
  }
  if (other_ > 0) types["other"] = other_;
  return types;
}

}  // namespace kinescope::app
