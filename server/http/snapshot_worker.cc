#include "server/http/snapshot_worker.h"

#include <exception>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::http {
namespace {

SnapshotResult Draw(PictureFeed& feed, const SnapshotRequest& request) {
  try {
    return feed.SnapshotPng(request.camera, request.width, request.height);
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

bool SnapshotWorker::Submit(SnapshotRequest request, std::function<void(SnapshotResult)> done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (tasks_.size() >= kMaxWaiting) return false;
    tasks_.push_back({std::move(request), std::move(done)});
  }
  changed_.notify_one();
  return true;
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
    task.done(Draw(feed_, task.request));
  }
}

}  // namespace kinescope::http
