/// Renders snapshots one after the other on its own thread, because PictureFeed blocks while it
/// renders and the server's thread must not. The queue is short: further requests are asked to try
/// again. Submit may be called on any thread.
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

#include "server/http/answer.h"
#include "server/http/server.h"

namespace kinescope::http {

/// Status of a snapshot that was not rendered because its client had left.
inline constexpr int kAbandoned = 0;

struct SnapshotFailure {
  int status = 500;  // 400 for a UsageError, 503 for anything else
  std::string reason;
};
using SnapshotResult = tl::expected<std::vector<std::uint8_t>, SnapshotFailure>;

class SnapshotWorker {
 public:
  static constexpr std::size_t kMaxWaiting = 8;
  static constexpr std::ptrdiff_t kMaxWaitingPerAddress = 2;

  explicit SnapshotWorker(PictureFeed& feed);
  ~SnapshotWorker();  // waits for the current picture; queued ones are dropped
  SnapshotWorker(const SnapshotWorker&) = delete;
  SnapshotWorker& operator=(const SnapshotWorker&) = delete;

  enum class Submission { kQueued, kQueueFull, kShareFull };
  /// Queues a snapshot for the client at `address`. `done` is called on the worker's thread, unless
  /// the queue or the share of this address is full. The snapshot is not rendered if `is_wanted` is
  /// false when it is its turn.
  [[nodiscard]] Submission Submit(const std::string& address, SnapshotRequest request,
                                  std::shared_ptr<const std::atomic<bool>> is_wanted,
                                  std::function<void(SnapshotResult)> done);

 private:
  struct SnapshotTask {
    std::string address;
    SnapshotRequest request;
    std::shared_ptr<const std::atomic<bool>> is_wanted;
    std::function<void(SnapshotResult)> done;
  };
  void Run();

  PictureFeed& feed_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SnapshotTask> tasks_;  // guarded by mutex_
  bool stopping_ = false;           // guarded by mutex_
  std::thread thread_;              // last: starts when all other members exist
};

}  // namespace kinescope::http
