/// Detects a driver that hangs (it cannot be interrupted). A watchdog thread is notified when
/// driver work starts and ends, and calls OnHang if the limit is exceeded. After the limit, a
/// quarter of it more has to pass in which no thread of this process waits for a core: on a machine
/// that is busy with more urgent work, a driver that works well takes as long as that lasts.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace kinescope::render {

class Watchdog {
 public:
  using Clock = std::chrono::steady_clock;
  /// Called on the watchdog's thread, once per piece of work that exceeds its limit.
  using OnHang = std::function<void(const std::string& what)>;

  explicit Watchdog(OnHang on_hang);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Driver work goes on while this object exists; `what` is for OnHang. One at a time, from one
  /// thread.
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
  // How long each thread of this process has waited for a core, by its number.
  using Waits = std::map<std::string, std::chrono::nanoseconds>;
  static Waits WaitsForACore();

  void Run();
  bool HasHadItsTime();

  const OnHang on_hang_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  bool stop_ = false;
  bool works_ = false;
  Clock::time_point deadline_;  // of the work; then when it is looked at again
  Clock::duration more_{};      // after its limit, in which no thread waits for a core
  Waits waits_;                 // when its limit had passed; empty: it has not
  Clock::time_point limit_passed_;
  Clock::time_point wake_ = Clock::time_point::max();
  std::function<std::string()> what_;

  std::thread thread_;
};

/// Last resort: prints `what` like main() and ends the process immediately with exit code 2.
/// Destructors do not run, so incomplete files must not have a name yet (new_file.h).
[[noreturn]] void EndProcess(const std::string& what);

}  // namespace kinescope::render
