/// Tells a web server of alarms: a POST with JSON for each. On a thread of its own, so that a
/// server which does not answer delays nothing. Any thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace kinescope::alarms {

struct WebhookCounters {
  std::uint64_t delivered = 0;
  std::uint64_t failed = 0;   // given up after all tries
  std::uint64_t dropped = 0;  // too many were waiting
  std::string last_error;     // "" if the last try succeeded
};

class Webhook {
 public:
  struct Settings {
    std::string url;  // http or https
    /// Of one try, and before the next one; the number of tries.
    double timeout_secs = 5, pause_secs = 2;
    int tries = 3;
    /// Receives a line when tries fail after a success, and when they succeed again. On the
    /// webhook's thread. May be null.
    std::function<void(const std::string& line)> warn;
  };

  explicit Webhook(Settings settings);
  /// Ends a try that runs; what waits is dropped.
  ~Webhook();
  Webhook(const Webhook&) = delete;
  Webhook& operator=(const Webhook&) = delete;

  /// `body`: JSON. Returns at once.
  void Send(std::string body);
  WebhookCounters counters() const;

  static constexpr std::size_t kMostWaiting = 1000;

 private:
  void Run();
  void Deliver(const std::string& body);
  bool Pause();
  /// "", or why it failed.
  std::string Post(const std::string& body);
  void Note(const std::string& error);

  const Settings settings_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  std::deque<std::string> waiting_;
  WebhookCounters counters_;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace kinescope::alarms
