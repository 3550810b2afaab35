#include "server/http/snapshot_worker.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::http {
namespace {

SnapshotResult Draw(PictureFeed& feed, const SnapshotRequest& request, bool is_wanted) {
  if (!is_wanted) return tl::unexpected(SnapshotFailure{kAbandoned, "the client has left"});
  try {
    return feed.SnapshotPng(request);
  } catch (const UsageError& error) {
    return tl::unexpected(SnapshotFailure{400, error.what()});
  } catch (const std::exception& error) {
    return tl::unexpected(SnapshotFailure{503, error.what()});
  }
}

}  // namespace

SnapshotWorker::SnapshotWorker(PictureFeed& feed) : feed_(feed), thread_([this] { Run(); }) {}

SnapshotWorker::~SnapshotWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

SnapshotWorker::Submission SnapshotWorker::Submit(
    const std::string& address, SnapshotRequest request,
    std::shared_ptr<const std::atomic<bool>> is_wanted, std::function<void(SnapshotResult)> done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (tasks_.size() >= kMaxWaiting) return Submission::kQueueFull;
    const auto waiting = std::count_if(tasks_.begin(), tasks_.end(), [&](const SnapshotTask& task) {
      return task.address == address && *task.is_wanted;
    });
    if (waiting >= kMaxWaitingPerAddress) return Submission::kShareFull;
    tasks_.push_back({address, std::move(request), std::move(is_wanted), std::move(done)});
  }
  changed_.notify_one();
  return Submission::kQueued;
}

void SnapshotWorker::Run() {
  while (true) {
    SnapshotTask task;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (stopping_) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task.done(Draw(feed_, task.request, *task.is_wanted));
  }
}

}  // namespace kinescope::http
