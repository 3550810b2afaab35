#include "server/app/batch/job_worker.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

#include "core/system/clocks.h"
#include "core/system/stop_signal.h"
#include "server/app/batch/job_command.h"
#include "server/app/batch/job_result.h"
#include "server/app/batch/one_core.h"
#include "server/app/log.h"
#include "server/app/print.h"
#include "server/app/render/draw_pools.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostWarnings = 20;

double CpuSecs(int who) {
  rusage used = {};
  ::getrusage(who, &used);
  const auto secs = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return secs(used.ru_utime) + secs(used.ru_stime);
}

// The kernel forgets the highest so far.
void ForgetPeakMemory() { std::ofstream("/proc/self/clear_refs") << "5"; }

std::int64_t PeakMemoryBytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::strtoll(line.c_str() + 6, nullptr, 10) * 1024;
  }
  return 0;
}

std::int64_t PeakMemoryBytesOfChildren() {
  rusage used = {};
  ::getrusage(RUSAGE_CHILDREN, &used);
  return used.ru_maxrss * std::int64_t{1024};
}

// What one job costs, from its construction on.
class Cost {
 public:
  Cost() { ForgetPeakMemory(); }

  void Write(JobResult& result) const {
    const double of_children = CpuSecs(RUSAGE_CHILDREN) - children_;
    result.secs = Secs(MonotonicNanos() - began_);
    result.cpu_secs = CpuSecs(RUSAGE_SELF) - self_ + of_children;
    result.peak_memory_bytes = PeakMemoryBytes();
    if (of_children > 0) {
      result.peak_memory_bytes = std::max(result.peak_memory_bytes, PeakMemoryBytesOfChildren());
    }
  }

 private:
  const std::int64_t began_ = MonotonicNanos();
  const double self_ = CpuSecs(RUSAGE_SELF), children_ = CpuSecs(RUSAGE_CHILDREN);
};

class Worker {
 public:
  Worker() {
    // What commands log belongs to their jobs.
    auto log = std::make_shared<spdlog::logger>("kinescope", log_);
    spdlog::set_default_logger(log);
  }

  JobResult Do(const Job& job) {
    JobResult result = ResultFor(job);
    const Cost cost;
    try {
      Run(job, result);
    } catch (const std::exception& error) {
      result.state = StopRequested() ? JobState::kInterrupted : JobState::kFailed;
      result.reason = error.what();
    }
    cost.Write(result);
    for (const LogLine& line : log_->Take()) {
      if (line.level < spdlog::level::warn || result.warnings.size() == kMostWarnings) continue;
      result.warnings.push_back(line.text);
    }
    return result;
  }

 private:
  void Run(const Job& job, JobResult& result) {
    Command command = CommandOf(job, pools_);
    for (const std::string& path : InputsOf(command)) result.inputs.push_back(StampOf(path));
    const std::vector<FileStamp> before = StampsOf(OutputsOf(command));
    const int exit_code = command.run(command.options);
    const std::vector<DeclaredOutput> outputs = OutputsOf(command);
    for (const DeclaredOutput& output : outputs) {
      result.outputs.push_back({output.option, StampOf(output), HashOf(output), output.kind});
    }
    result.state = exit_code != 0                ? JobState::kFailed
                   : before == StampsOf(outputs) ? JobState::kKept
                                                 : JobState::kDone;
    if (outputs.empty() && exit_code == 0) result.state = JobState::kDone;
    if (exit_code != 0) result.reason = command.failure;
  }

  static std::vector<FileStamp> StampsOf(const std::vector<DeclaredOutput>& outputs) {
    std::vector<FileStamp> stamps;
    stamps.reserve(outputs.size());
    for (const DeclaredOutput& output : outputs) stamps.push_back(StampOf(output));
    return stamps;
  }

  const std::shared_ptr<LogTail> log_ = std::make_shared<LogTail>();
  const std::shared_ptr<DrawPools> pools_ = std::make_shared<DrawPools>();
};

}  // namespace

int WorkOff() {
  IgnoreFurtherStopSignals();
  std::FILE* const orders = ::fdopen(kOrdersFrom, "r");
  std::FILE* const results = ::fdopen(kResultsTo, "w");
  if (orders == nullptr || results == nullptr) return 2;
  Worker worker;
  char* line = nullptr;
  std::size_t room = 0;
  while (!StopRequested()) {
    const ssize_t size = ::getline(&line, &room, orders);
    if (size <= 0) break;
    UseOneCore();
    const Job job = ReadJob(std::string_view(line, static_cast<std::size_t>(size)));
    PrintText(results, ToLine(worker.Do(job)) + "\n");
    std::fflush(results);
  }
  std::free(line);
  return 0;
}

}  // namespace kinescope::app
