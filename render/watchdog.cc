#include "render/watchdog.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/system/utf8.h"

namespace kinescope::render {

Watchdog::Watchdog(OnHang on_hang) : on_hang_(std::move(on_hang)), thread_([this] { Run(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

Watchdog::Work::Work(Watchdog& watchdog, std::chrono::milliseconds limit,
                     std::function<std::string()> what)
    : watchdog_(watchdog) {
  bool is_earlier = false;
  {
    const std::lock_guard<std::mutex> lock(watchdog_.mutex_);
    watchdog_.works_ = true;
    watchdog_.deadline_ = Clock::now() + limit;
    watchdog_.more_ = limit / 4;
    watchdog_.waits_.clear();
    watchdog_.what_ = std::move(what);
    is_earlier = watchdog_.deadline_ < watchdog_.wake_;
  }
  if (is_earlier) watchdog_.changed_.notify_one();
}

Watchdog::Work::~Work() {
  const std::lock_guard<std::mutex> lock(watchdog_.mutex_);
  watchdog_.works_ = false;
}

// From the kernel's accounts; empty where it keeps none.
Watchdog::Waits Watchdog::WaitsForACore() {
  Waits waits;
  std::error_code error;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
    std::ifstream file(task.path() / "schedstat");
    std::int64_t running_nanos = 0, waiting_nanos = 0;
    if (file >> running_nanos >> waiting_nanos) {
      waits[task.path().filename()] = std::chrono::nanoseconds(waiting_nanos);
    }
  }
  return waits;
}

// Called at each deadline_, which it moves while time is left.
bool Watchdog::HasHadItsTime() {
  constexpr Clock::duration kBetweenLooks = std::chrono::milliseconds(200);
  const Clock::time_point now = Clock::now();
  const Waits waits = WaitsForACore();
  if (waits_.empty()) {
    if (waits.empty()) return true;
    limit_passed_ = now;
    waits_ = waits;
  } else {
    std::chrono::nanoseconds longest(0);  // that any thread has waited since
    for (const auto& [thread, waited] : waits) {
      const auto before = waits_.find(thread);
      if (before != waits_.end()) longest = std::max(longest, waited - before->second);
    }
    if (now - limit_passed_ - longest >= more_) return true;
  }
  deadline_ = now + std::min(more_, kBetweenLooks);
  return false;
}

// Wakes at most once for each limit, not once for each picture: a later deadline is found when the
// earlier one has passed.
void Watchdog::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    if (!works_) {
      wake_ = Clock::time_point::max();
      // Work that ends before the old deadline leaves wake_ as it is, so that the next needs no
      // call.
      changed_.wait(lock, [&] { return stop_ || works_; });
      continue;
    }
    wake_ = deadline_;
    if (changed_.wait_until(lock, wake_, [&] { return stop_ || deadline_ < wake_; })) continue;
    if (!works_ || Clock::now() < deadline_ || !HasHadItsTime()) continue;
    const std::string what = what_();
    works_ = false;  // said once
    lock.unlock();
    on_hang_(what);
    lock.lock();
  }
}

void EndProcess(const std::string& what) {
  std::fprintf(stderr, "kinescope: %s\n", PrintableLine(what).c_str());
  std::fflush(stderr);
  ::_exit(2);
}

}  // namespace kinescope::render
