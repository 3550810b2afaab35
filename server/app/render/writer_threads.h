/// Writes items on separate threads, in the order in which they are added. Errors in these threads
/// are thrown on the calling thread. One thread calls it.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace kinescope::app {

template <class Item>
class WriterThreads {
 public:
  using Write = std::function<void(Item&)>;

  /// Each item is passed to `write` once, on one of `count` threads; with one thread, in order. The
  /// queue has no limit: items are futures, and DrawPool limits their number.
  WriterThreads(int count, Write write) : write_(std::move(write)) {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { Work(); });
  }

  /// Discards the items that are not written yet.
  ~WriterThreads() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
      discards_ = true;
    }
    Join();
  }
  WriterThreads(const WriterThreads&) = delete;
  WriterThreads& operator=(const WriterThreads&) = delete;

  /// @throws the exception from writing an earlier item.
  void Put(Item item) {
    {
      const std::lock_guard lock(mutex_);
      if (failure_) std::rethrow_exception(failure_);
      items_.push_back(std::move(item));
    }
    changed_.notify_one();
  }

  /// Waits until everything is written. @throws the exception from writing.
  void Finish() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
    }
    Join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void Join() {
    changed_.notify_all();
    for (std::thread& thread : threads_) {
      if (thread.joinable()) thread.join();
    }
  }

  void Work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return is_closed_ || !items_.empty(); });
      if (items_.empty()) return;
      {
        Item item = std::move(items_.front());
        items_.pop_front();
        const bool writes = !discards_;
        lock.unlock();
        try {
          if (writes) write_(item);
        } catch (...) {
          const std::lock_guard again(mutex_);
          if (!failure_) failure_ = std::current_exception();
          discards_ = true;  // later items are only released
        }
      }  // releases the item before waiting for the next one
      lock.lock();
    }
  }

  const Write write_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;  // guarded by mutex_, like all following members
  std::exception_ptr failure_;
  bool is_closed_ = false;
  bool discards_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace kinescope::app
