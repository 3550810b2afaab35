#include "server/app/golden/golden_jobs.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/stop_signal.h"
#include "server/app/golden/case_process.h"
#include "server/app/golden/golden_verdict_json.h"
#include "server/app/print.h"

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

class Jobs {
 public:
  Jobs(const GoldenSuite& suite, const JobSettings& settings,
       const std::function<void(const CaseVerdict&)>& report)
      : suite_(suite),
        settings_(settings),
        report_(report),
        done_(suite.cases.size()),
        workers_(
            std::min<std::size_t>(static_cast<std::size_t>(settings.jobs), suite.cases.size())) {}

  void Run() {
    while (reported_ < done_.size()) {
      if (StopRequested()) {
        throw std::runtime_error(
            fmt::format("interrupted after {} of {} cases", reported_, done_.size()));
      }
      for (Worker& worker : workers_) GiveWork(worker);
      WaitForAnswers();
      for (Worker& worker : workers_) EndIfTooLate(worker);
      Report();
    }
  }

 private:
  struct Worker {
    std::unique_ptr<CaseProcess> process;
    bool is_ready = false;  // it can draw
    std::optional<std::size_t> at;
    Clock::time_point deadline;
  };

  void GiveWork(Worker& worker) {
    if (worker.at || next_ == done_.size()) return;
    if (!worker.process) {
      worker.process = std::make_unique<CaseProcess>(settings_.command);
      worker.is_ready = false;
    }
    worker.at = next_++;
    worker.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(settings_.limit_secs));
    worker.process->Ask(suite_.cases[*worker.at].name);
  }

  void WaitForAnswers() {
    constexpr int kPollMillis = 200;  // for Ctrl-C and for what is too late
    std::vector<pollfd> wanted;
    for (const Worker& worker : workers_) {
      wanted.push_back({worker.process && worker.at ? worker.process->fd() : -1, POLLIN, 0});
    }
    if (::poll(wanted.data(), wanted.size(), kPollMillis) <= 0) return;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (wanted[i].revents != 0) Receive(workers_[i]);
    }
  }

  void Receive(Worker& worker) {
    std::vector<std::string> lines;
    const bool goes_on = worker.process->Read(lines);
    for (const std::string& line : lines) Take(worker, ParseJsonOrThrow(line));
    if (!goes_on) OnEnd(worker, worker.process->End());
  }

  void Take(Worker& worker, const json& answer) {
    if (answer.is_object()) {
      if (answer.contains("error")) {
        throw std::runtime_error(answer.at("error").get<std::string>());
      }
      worker.is_ready = true;
      return;
    }
    std::vector<CaseVerdict> verdicts;
    for (const json& each : answer) verdicts.push_back(VerdictFrom(each));
    Finish(worker, std::move(verdicts));
  }

  void OnEnd(Worker& worker, const std::string& how) {
    if (!worker.is_ready) {
      throw std::runtime_error("the process that draws " + how + " before it could draw");
    }
    worker.process.reset();
    if (worker.at) Fail(worker, "the process that drew it " + how);
  }

  void EndIfTooLate(Worker& worker) {
    if (!worker.at || Clock::now() < worker.deadline) return;
    worker.process.reset();
    Fail(worker, fmt::format("was not finished within {:g} s (--case_limit_secs) and was ended",
                             settings_.limit_secs));
  }

  void Fail(Worker& worker, const std::string& reason) {
    const FoundCase& found = suite_.cases[*worker.at];
    CaseVerdict verdict;
    verdict.name = found.name;
    verdict.file = suite_.CaseFileOf(found);
    if (found.read) verdict.why = *found.read->why;
    verdict.outcome = Outcome::kNotCompared;
    verdict.reason = verdict.file.string() + ": " + reason;
    if (const AcceptedCase* const accepted = suite_.AcceptedOf(found.name)) {
      verdict.accepted_pixels = accepted->pixels_sha256;
    }
    Finish(worker, {verdict});
  }

  void Finish(Worker& worker, std::vector<CaseVerdict> verdicts) {
    done_[*worker.at] = std::move(verdicts);
    worker.at.reset();
  }

  void Report() {
    for (; reported_ < done_.size() && done_[reported_]; ++reported_) {
      for (const CaseVerdict& verdict : *done_[reported_]) report_(verdict);
    }
  }

  const GoldenSuite& suite_;
  const JobSettings& settings_;
  const std::function<void(const CaseVerdict&)>& report_;
  std::vector<std::optional<std::vector<CaseVerdict>>> done_;  // by case
  std::vector<Worker> workers_;
  std::size_t next_ = 0, reported_ = 0;
};

void WriteAnswer(const nlohmann::ordered_json& line) {
  PrintText(stdout, JsonText(line) + "\n");
  std::fflush(stdout);
}

const FoundCase& CaseNamed(const std::string& name, const GoldenSuite& suite) {
  const auto found = std::find_if(suite.cases.begin(), suite.cases.end(),
                                  [&](const FoundCase& each) { return each.name == name; });
  if (found == suite.cases.end()) throw std::runtime_error("case '" + name + "' is not there");
  return *found;
}

}  // namespace

std::vector<std::string> CommandOfJobs(const std::string& folder, const CheckSettings& settings,
                                       const BackendOptions& backend) {
  std::vector<std::string> command = {std::filesystem::read_symlink("/proc/self/exe").string(),
                                      "golden",
                                      "check",
                                      "--answers",
                                      "--folder=" + folder,
                                      "--out=" + settings.out.string(),
                                      "--backend=" + backend.backend.ToText(),
                                      "--draw_limit_secs=" + backend.draw_limit_secs.ToText()};
  if (settings.is_strict) command.emplace_back("--strict");
  if (settings.keeps_all) command.emplace_back("--all_pictures");
  return command;
}

void CheckInProcesses(const GoldenSuite& suite, const JobSettings& settings,
                      const std::function<void(const CaseVerdict&)>& report) {
  Jobs(suite, settings, report).Run();
  for (const CaseVerdict& verdict : VerdictsOfNoCase(suite)) report(verdict);
}

void AnswerOrders(const GoldenSuite& suite, const CheckSettings& settings,
                  const BackendOptions& backend) {
  try {
    const auto renderer = StartRenderer(backend);
    const auto environment = EnvironmentOf(renderer->info());
    WriteAnswer({{"is_ready", true}});
    for (std::string name; std::getline(std::cin, name, '\0');) {
      nlohmann::ordered_json verdicts = nlohmann::ordered_json::array();
      for (const CaseVerdict& each :
           CheckCase(suite, CaseNamed(name, suite), settings, environment, *renderer)) {
        verdicts.push_back(ToWholeJson(each, settings.out));
      }
      WriteAnswer(verdicts);
    }
  } catch (const std::exception& error) {
    WriteAnswer({{"error", error.what()}});
  }
}

}  // namespace kinescope::app
