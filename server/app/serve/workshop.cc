#include "server/app/serve/workshop.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace kinescope::app {
namespace {

constexpr int kNice = 15;  // of a process that may use what others leave

}  // namespace

const char* Name(Workshop::State state) {
  switch (state) {
    case Workshop::State::kWaiting: return "waiting";
    case Workshop::State::kMaking: return "making";
    case Workshop::State::kDone: return "done";
    case Workshop::State::kFailed: return "failed";
    case Workshop::State::kCancelled: break;
  }
  return "cancelled";
}

Workshop::Workshop() : thread_([this] { Run(); }) {}

Workshop::~Workshop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closing_ = true;
    for (Entry& entry : entries_) entry.progress->is_wanted_ = false;
  }
  changed_.notify_all();
  thread_.join();
}

tl::expected<std::uint64_t, std::string> Workshop::Add(std::string kind, std::string file,
                                                       Work work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::size_t open = 0;
  for (const Entry& entry : entries_) {
    if (!IsOpen(entry.job.state)) continue;
    ++open;
    if (entry.job.file == file) return tl::unexpected(file + " is being made already");
  }
  if (open >= kMostWaiting) {
    return tl::unexpected(std::to_string(open) +
                          " clips and reports wait already; try again when some are done");
  }
  Entry entry;
  entry.job.id = ++last_id_;
  entry.job.kind = std::move(kind);
  entry.job.file = std::move(file);
  entry.work = std::move(work);
  entries_.push_back(std::move(entry));
  changed_.notify_all();
  return last_id_;
}

bool Workshop::Cancel(std::uint64_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Entry& entry : entries_) {
    if (entry.job.id != id || !IsOpen(entry.job.state)) continue;
    entry.progress->is_wanted_ = false;
    if (entry.job.state == State::kWaiting) {
      entry.job.state = State::kCancelled;
      Forget();
    }
    return true;
  }
  return false;
}

std::vector<Workshop::Job> Workshop::jobs() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Job> jobs;
  for (const Entry& entry : entries_) {
    jobs.push_back(entry.job);
    if (entry.job.state == State::kMaking) jobs.back().progress = entry.progress->share_;
  }
  return jobs;
}

// @pre mutex_ is held
void Workshop::Forget() {
  auto ended = std::count_if(entries_.begin(), entries_.end(),
                             [](const Entry& entry) { return !IsOpen(entry.job.state); });
  for (auto entry = entries_.begin(); ended > static_cast<std::ptrdiff_t>(kMostEnded);) {
    if (IsOpen(entry->job.state)) {
      ++entry;
      continue;
    }
    entry = entries_.erase(entry);
    --ended;
  }
}

void Workshop::Run() {
  // Of this thread, and of those that it starts.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  std::unique_lock<std::mutex> lock(mutex_);
  const auto find = [this](auto is_right) {
    return std::find_if(entries_.begin(), entries_.end(), is_right);
  };
  while (true) {
    const auto waits = [](const Entry& entry) { return entry.job.state == State::kWaiting; };
    changed_.wait(lock, [&] { return is_closing_ || find(waits) != entries_.end(); });
    if (is_closing_) return;
    const auto next = find(waits);
    next->job.state = State::kMaking;
    const std::uint64_t id = next->job.id;
    const Work work = std::move(next->work);
    const std::shared_ptr<Progress> progress = next->progress;
    lock.unlock();
    std::string problem;
    try {
      work(*progress);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    const auto done = find([id](const Entry& entry) { return entry.job.id == id; });
    done->job.state = !progress->is_wanted() ? State::kCancelled
                      : problem.empty()      ? State::kDone
                                             : State::kFailed;
    done->job.progress = problem.empty() ? 1 : progress->share_.load();
    done->job.problem = std::move(problem);
    Forget();
    ++ended_;
  }
}

}  // namespace kinescope::app
