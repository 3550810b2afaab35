#include "render/watchdog.h"

#include <unistd.h>

#include <cstdio>
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
    watchdog_.what_ = std::move(what);
    is_earlier = watchdog_.deadline_ < watchdog_.wake_;
  }
  if (is_earlier) watchdog_.changed_.notify_one();
}

Watchdog::Work::~Work() {
  const std::lock_guard<std::mutex> lock(watchdog_.mutex_);
  watchdog_.works_ = false;
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
    if (!works_ || Clock::now() < deadline_) continue;
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
