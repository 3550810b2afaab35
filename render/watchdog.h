/// A driver that hangs cannot be interrupted, but it can be said. The watchdog is a thread that is
/// told when work in the driver begins and ends, and speaks up when it has not ended in time.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace kinescope::render {

class Watchdog {
 public:
  using Clock = std::chrono::steady_clock;
  /// Called on the watchdog's own thread, once for each piece of work that takes too long.
  using OnHang = std::function<void(const std::string& what)>;

  explicit Watchdog(OnHang on_hang);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// While it lives, work goes on; `what` is for OnHang. One at a time, of one thread.
  class [[nodiscard]] Work {
   public:
    Work(Watchdog& watchdog, std::chrono::milliseconds limit, std::function<std::string()> what);
    ~Work();
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

   private:
    Watchdog& watchdog_;
  };

 private:
  void Run();

  const OnHang on_hang_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  bool stop_ = false;
  bool works_ = false;
  Clock::time_point deadline_;  // of the work
  Clock::time_point wake_ = Clock::time_point::max();
  std::function<std::string()> what_;

  std::thread thread_;
};

/// What is to be done when nobody else can do anything: says `what` as main() would and ends the
/// process at once with exit code 2. Destructors do not run, so files that are not finished must
/// have no name yet (new_file.h).
[[noreturn]] void EndProcess(const std::string& what);

}  // namespace kinescope::render
