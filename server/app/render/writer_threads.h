/// Threads that write what another one hands them, in that order, while it goes on. What fails
/// there is thrown here.
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

  /// Each item is given to `write` once, on one of `count` threads; with one thread, in order.
  /// Nothing here bounds the queue: items are promises, and who makes them waits (DrawPool).
  WriterThreads(int count, Write write) : write_(std::move(write)) {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { Work(); });
  }

  /// Throws away what is not yet written.
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

  /// @throws what writing an earlier item threw.
  void Put(Item item) {
    {
      const std::lock_guard lock(mutex_);
      if (failure_) std::rethrow_exception(failure_);
      items_.push_back(std::move(item));
    }
    changed_.notify_one();
  }

  /// Waits until everything is written. @throws what writing threw.
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
          discards_ = true;  // and what comes after it frees its memory
        }
      }  // lets go of the item before it waits for the next
      lock.lock();
    }
  }

  const Write write_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;  // guarded by mutex_, as all that follows
  std::exception_ptr failure_;
  bool is_closed_ = false;
  bool discards_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace kinescope::app
