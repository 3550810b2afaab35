/// Makes files that take time (clips, reports) one after the other, on a thread of low priority, so
/// that the live stream goes on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <tl/expected.hpp>
#include <vector>

namespace kinescope::app {

class Workshop {
 public:
  enum class State { kWaiting, kMaking, kDone, kFailed, kCancelled };
  struct Job {
    std::uint64_t id = 0;
    std::string kind;  // "clip", "report"
    std::string file;  // name of what it makes
    State state = State::kWaiting;
    double progress = 0;  // 0 to 1; of a report: 0 until it is done
    std::string problem;  // why it failed
  };

  /// Between the work and those who wait for it.
  class Progress {
   public:
    void Set(double share) { share_ = share; }
    bool is_wanted() const { return is_wanted_; }  // false: stop, and leave nothing behind

   private:
    friend class Workshop;
    std::atomic<double> share_{0};
    std::atomic<bool> is_wanted_{true};
  };
  /// Makes the file. @throws std::exception with one line for the client
  using Work = std::function<void(Progress& progress)>;

  Workshop();
  ~Workshop();  // cancels everything, and waits for the work that is being done
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// @return the id, or why not: too many jobs wait, or one of them makes the same file
  tl::expected<std::uint64_t, std::string> Add(std::string kind, std::string file, Work work);
  /// False if there is no such job that waits or is being done.
  [[nodiscard]] bool Cancel(std::uint64_t id);

  /// Those that wait and the newest others, by id.
  std::vector<Job> jobs() const;
  /// Grows when a job has ended.
  std::uint64_t ended() const { return ended_; }

  static constexpr std::size_t kMostWaiting = 100;
  static constexpr std::size_t kMostEnded = 8;

 private:
  struct Entry {
    Job job;
    Work work;
    std::shared_ptr<Progress> progress = std::make_shared<Progress>();
  };

  void Run();
  void Forget();
  static bool IsOpen(State state) { return state == State::kWaiting || state == State::kMaking; }

  std::atomic<std::uint64_t> ended_{0};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  std::deque<Entry> entries_;  // by id
  std::uint64_t last_id_ = 0;
  bool is_closing_ = false;

  std::thread thread_;  // last: starts when all other members exist
};

/// "waiting", "making", "done", "failed", "cancelled".
const char* Name(Workshop::State state);

}  // namespace kinescope::app
