/// Passes the latest value to other threads; older values are dropped, never queued. Any thread may
/// call any function. A published value never changes, so readers share it instead of copying.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace kinescope {

template <class T>
class Latest {
 public:
  void Publish(std::shared_ptr<const T> value) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      value_ = std::move(value);
      ++version_;
    }
    changed_.notify_all();
  }

  /// The newest value; null before the first Publish.
  std::shared_ptr<const T> Get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value_;
  }

  /// Waits up to `timeout` for a version newer than `seen` and updates `seen`; null if there was
  /// none. Start with `seen` = 0.
  std::shared_ptr<const T> WaitNewer(std::uint64_t& seen, std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, timeout, [&] { return version_ != seen || interrupted_; }) ||
        version_ == seen) {
      return nullptr;
    }
    seen = version_;
    return value_;
  }

  /// Makes WaitNewer return at once from now on: for shutting down.
  void Interrupt() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      interrupted_ = true;
    }
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const T> value_;  // guarded by mutex_
  std::uint64_t version_ = 0;       // guarded by mutex_
  bool interrupted_ = false;        // guarded by mutex_
};

}  // namespace kinescope
