#include "server/app/batch/batch_run.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/stop_signal.h"
#include "server/app/process_group.h"

namespace kinescope::app {
namespace {

using Clock = ProcessGroup::Clock;

// To end what it does, before it is killed. Schedulers kill after 30 s at the earliest.
constexpr std::chrono::seconds kTimeToStop(8);
constexpr std::chrono::milliseconds kLookEvery(100);  // whether the user stops this program

ProcessGroup::Settings SettingsOfWorker() {
  ProcessGroup::Settings settings;
  settings.command = {std::filesystem::read_symlink("/proc/self/exe").string(), "batch",
                      "--answers"};
  // The one core that a process has draws faster if no other thread has to be woken up.
  settings.environment = {"LP_NUM_THREADS=0"};
  settings.has_channel = true;
  settings.ends_on_stop = false;
  return settings;
}

// One process at a time, which does one job at a time. Belongs to one thread.
class Slot {
 public:
  explicit Slot(double limit_secs) : limit_secs_(limit_secs) {}

  JobResult Do(const Job& job) {
    JobResult result = ResultFor(job);
    const std::int64_t began = MonotonicNanos();
    try {
      if (worker_ == nullptr) worker_ = std::make_unique<ProcessGroup>(SettingsOfWorker());
      const std::optional<std::string> answer = Ask(job, result);
      if (answer) {
        JobResult answered = ReadResult(*answer);
        if (answered.state == JobState::kInterrupted) worker_.reset();  // it does no more jobs
        return answered;
      }
    } catch (const std::exception& error) {
      result.state = JobState::kFailed;
      result.reason = error.what();
    }
    worker_.reset();
    result.secs = Secs(MonotonicNanos() - began);
    return result;
  }

 private:
  // The line of results; nullopt: the process has not answered, and `result` says why.
  std::optional<std::string> Ask(const Job& job, JobResult& result) {
    const Clock::time_point limit = LimitFromNow();
    std::optional<Clock::time_point> stop;
    std::string received;
    if (!worker_->Send(ToLine(job) + "\n", Clock::now() + kTimeToStop)) {
      return Unanswered(result);
    }
    while (true) {
      const bool has_read = worker_->Read(Clock::now() + kLookEvery);
      received += worker_->TakeReceived();
      if (!received.empty() && received.back() == '\n') return received;
      if (has_read && worker_->has_ended()) return Unanswered(result);
      if (StopRequested() && !stop) {
        worker_->Signal(SIGTERM);
        stop = Clock::now() + kTimeToStop;
      }
      if (stop && Clock::now() > *stop) return Interrupted(result);
      if (Clock::now() > limit) {
        result.state = JobState::kFailed;
        result.reason = fmt::format(
            "was not finished within {:g} s (--job_limit_secs) and was ended", limit_secs_);
        return std::nullopt;
      }
    }
  }

  Clock::time_point LimitFromNow() const {
    if (limit_secs_ <= 0) return Clock::time_point::max();
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_secs_));
  }

  static std::optional<std::string> Interrupted(JobResult& result) {
    result.state = JobState::kInterrupted;
    result.reason = "interrupted";
    return std::nullopt;
  }

  std::optional<std::string> Unanswered(JobResult& result) {
    const std::string ending = worker_->End();
    // A worker that was told to stop ends so.
    if (StopRequested() || ending == "exit code 0") return Interrupted(result);
    result.state = JobState::kFailed;
    result.reason = "its process ended with " + ending;
    std::string last;
    while (auto line = worker_->TakeLine()) last = *std::move(line);
    if (!last.empty()) result.reason += ": " + last;
    return std::nullopt;
  }

  const double limit_secs_;
  std::unique_ptr<ProcessGroup> worker_;
};

class Run {
 public:
  Run(const std::vector<const Job*>& jobs, const BatchSettings& settings,
      const std::function<void(JobResult)>& report)
      : jobs_(jobs), settings_(settings), report_(report) {}

  void DoAll() {
    const std::size_t count =
        std::min(jobs_.size(), static_cast<std::size_t>(std::max(1, settings_.jobs)));
    std::vector<std::thread> threads;
    threads.reserve(count);
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([this] { Work(); });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  void Work() {
    Slot slot(settings_.limit_secs);
    while (const Job* const job = Next()) {
      Report(StopRequested() ? NotBegun(*job) : slot.Do(*job));
    }
  }

  const Job* Next() {
    const std::lock_guard lock(mutex_);
    return next_ < jobs_.size() ? jobs_[next_++] : nullptr;
  }

  static JobResult NotBegun(const Job& job) {
    JobResult result = ResultFor(job);
    result.reason = "interrupted before it began";
    result.attempts = 0;
    return result;
  }

  void Report(JobResult result) {
    const std::lock_guard lock(mutex_);
    report_(std::move(result));
  }

  const std::vector<const Job*>& jobs_;
  const BatchSettings settings_;
  const std::function<void(JobResult)>& report_;
  std::mutex mutex_;
  std::size_t next_ = 0;  // guarded by mutex_
};

}  // namespace

void DoJobs(const std::vector<const Job*>& jobs, const BatchSettings& settings,
            const std::function<void(JobResult)>& report) {
  Run(jobs, settings, report).DoAll();
}

}  // namespace kinescope::app
