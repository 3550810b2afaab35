// `kinescope golden check`: have the pictures that people see changed, and what in them?
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_github.h"
#include "server/app/golden/golden_jobs.h"
#include "server/app/golden/golden_junit.h"
#include "server/app/golden/golden_report.h"
#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_verdict_json.h"
#include "server/app/print.h"
#include "server/app/shard.h"
#include "server/app/shell_word.h"

namespace kinescope::app {
namespace {

struct CheckOptions {
  GoldenCaseOptions cases;
  options::Text out{"out/golden"}, junit, summary;
  options::Flag json, is_strict, keeps_all, answers;
  GoldenJobOptions jobs;
  ShardValue shard;
};

void PrintVerdict(const CaseVerdict& verdict) {
  const char* const how =
      verdict.outcome == Outcome::kSame && !verdict.is_byte_equal ? " (within the limits)" : "";
  const std::string frame = verdict.frame ? ", " + ToText(*verdict.frame) : "";
  Print("{:<24} {}{}{}\n", verdict.name, LoudName(verdict.outcome), how, frame);
  if (verdict.outcome != Outcome::kSame && !verdict.why.empty()) {
    Print("  purpose: {}\n", verdict.why);
  }
  for (const std::string& line : Explain(verdict)) Print("  {}\n", line);
}

void PrintSummary(const OutcomeCounts& counts, const CheckOptions& options) {
  const std::string share =
      options.shard->count == 1 ? "" : fmt::format("Shard {}: ", options.shard.ToText());
  Print("{}{}\n", share, Headline(counts));
  if (counts.ExitCode() == 0) return;
  Print("Report: {}/report.html; to accept what it shows: kinescope golden review {}\n",
        *options.out, ShellWord(*options.out));
}

// What GitHub reads from standard output. Between Begin and End it obeys nothing, because names in
// verdicts come from files.
class GithubOutput {
 public:
  explicit GithubOutput(bool is_json)
      : is_on_(!is_json && std::getenv("GITHUB_ACTIONS") != nullptr) {
    std::random_device random;
    token_ = fmt::format("kinescope-{:08x}{:08x}", random(), random());
    if (is_on_) Print("::stop-commands::{}\n", token_);
  }
  void End(const std::vector<CaseVerdict>& verdicts, const std::string& out) const {
    if (!is_on_) return;
    Print("::{}::\n", token_);
    PrintText(stdout, ToAnnotations(verdicts, out));
    const char* const summary = std::getenv("GITHUB_STEP_SUMMARY");
    if (summary == nullptr) return;
    std::ofstream(summary, std::ios::app) << ToMarkdown(verdicts, out);
  }

 private:
  bool is_on_;
  std::string token_;
};

void WriteForServers(const CheckOptions& options, const std::vector<CaseVerdict>& verdicts) {
  if (!options.junit->empty()) {
    render::WriteNewFile(*options.junit, ToJunit(verdicts, *options.cases.folder, *options.out));
  }
  if (!options.summary->empty()) {
    render::WriteNewFile(*options.summary, ToMarkdown(verdicts, *options.out));
  }
}

void WriteResults(const CheckOptions& options, const GoldenSuite& suite,
                  const std::vector<CaseVerdict>& verdicts) {
  const std::filesystem::path out = *options.out;
  WriteRun(out, *options.cases.folder, verdicts);
  render::WriteNewFile(
      out / "report.html",
      GoldenReport(verdicts, {*options.cases.folder, suite.folder / suite.pictures, out}));
  WriteForServers(options, verdicts);
}

// What an earlier run has left would be taken for what this one found.
void RemoveOldResults(const CheckOptions& options) {
  namespace fs = std::filesystem;
  if (options.out->empty()) throw UsageError("--out: expected a folder");
  std::error_code ignored;
  if (fs::equivalent(*options.out, *options.cases.folder, ignored)) {
    throw UsageError(
        fmt::format("--out={}: is the folder of the cases, where its pictures would "
                    "belong to no case; choose another one",
                    *options.out));
  }
  ClearRun(*options.out);
  for (const std::string& file : {*options.junit, *options.summary}) {
    if (!file.empty() && fs::is_regular_file(file, ignored)) fs::remove(file, ignored);
  }
}

std::vector<DeclaredOutput> OutputsOf(const CheckOptions& options) {
  std::vector<DeclaredOutput> outputs = {{"out", *options.out, DeclaredOutput::Kind::kFolder}};
  if (!options.junit->empty()) outputs.push_back({"junit", *options.junit});
  if (!options.summary->empty()) outputs.push_back({"summary", *options.summary});
  return outputs;
}

// Stands for what could not be compared, where CI servers show it.
CaseVerdict FailureOf(const CheckOptions& options, const std::string& reason) {
  CaseVerdict verdict;
  verdict.name = "golden check";
  verdict.file = *options.cases.folder;
  verdict.outcome = Outcome::kNotCompared;
  verdict.reason = reason;
  return verdict;
}

void ReportFailure(const CheckOptions& options, const std::string& reason) {
  const std::vector<CaseVerdict> verdicts = {FailureOf(options, reason)};
  WriteForServers(options, verdicts);
  GithubOutput(*options.json).End(verdicts, *options.out);
}

int CheckSuite(const CheckOptions& options, const GoldenSuite& suite, const JobSettings& jobs) {
  const GithubOutput github(*options.json);
  std::vector<CaseVerdict> verdicts;
  std::exception_ptr failure;  // what was compared before it is still to be seen
  try {
    CheckInProcesses(suite, jobs, [&](const CaseVerdict& verdict) {
      verdicts.push_back(verdict);
      if (*options.json) {
        Print("{}\n", JsonText(ToJson(verdict, *options.out)));
      } else {
        PrintVerdict(verdict);
      }
      std::fflush(stdout);  // a log shows it now
    });
  } catch (const std::exception& error) {
    failure = std::current_exception();
    verdicts.push_back(FailureOf(options, error.what()));
  }
  const OutcomeCounts counts = CountsOf(verdicts);
  WriteResults(options, suite, verdicts);
  const bool is_empty = failure && verdicts.size() == 1;
  if (!*options.json && !is_empty) PrintSummary(counts, options);
  github.End(verdicts, *options.out);
  if (failure) std::rethrow_exception(failure);
  return counts.ExitCode();
}

int CheckAll(const CheckOptions& options) {
  const CheckSettings settings = {*options.out, *options.is_strict, *options.keeps_all};
  if (*options.answers) {
    AnswerOrders(options.cases.Find(), settings, options.jobs.backend);
    return 0;
  }
  RemoveOldResults(options);
  GoldenSuite suite;
  JobSettings jobs;
  try {
    suite = ShareOf(options.cases.Find(), *options.shard);
    jobs = options.jobs.Start(*options.cases.folder, suite.cases.size(), settings);
  } catch (const std::exception& error) {
    ReportFailure(options, error.what());
    throw;
  }
  return CheckSuite(options, suite, jobs);
}

}  // namespace

Command GoldenCheckCommand() {
  const auto values = std::make_shared<CheckOptions>();
  Command check;
  check.name = "check";
  check.about = "Draws every case and compares it with the accepted picture";
  values->cases.List(check.options);
  values->jobs.List(check.options);
  check.options("out", values->out,
                "folder for the report, the verdicts (run.json) and the pictures of cases that are "
                "not the same");
  check.options("shard", values->shard,
                "the share of the cases to compare, by a hash of their names, such as 2/4: for "
                "several jobs of a CI server");
  check.options("strict", values->is_strict,
                "only equal bytes in the accepted environment are the same");
  check.options("all_pictures", values->keeps_all,
                "write the pictures of cases that are the same, too");
  check.options("junit", values->junit, "JUnit XML file for CI servers");
  check.options("summary", values->summary, "Markdown file, for comments and pages of jobs");
  check.options("json", values->json, "print the verdicts as JSON");
  check.options.Group(options::kHidden);
  check.options("answers", values->answers, "compares the cases that standard input names");
  check.positionals = {"folder", "case"};
  check.footer =
      "Exit code: 0 all are the same, 1 a case differs or a picture belongs to no case, 2 a case "
      "could not be compared.\n"
      "In GitHub Actions, it writes annotations and the summary of the job by itself.";
  check.reads = {"folder"};
  check.outputs = [values] { return OutputsOf(*values); };
  check.failure = "a picture is not the accepted one";
  check.run = [values](options::OptionList&) { return CheckAll(*values); };
  return check;
}

}  // namespace kinescope::app
