// `kinescope study`: what the trials of a study say together, as a table, a page and CSV.
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/not_source.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/app/study/study.h"
#include "server/app/study/study_csv.h"
#include "server/app/study/study_page.h"
#include "server/app/study/study_text.h"
#include "server/options/value.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

struct StudyOptions {
  options::Texts results;
  options::Text list, report, csv, title;
  options::Text person{"person"}, condition{"condition"};
  LabelPattern labels;

  void List(options::OptionList& option) {
    option("results", results,
           "results of batch, and JSON files of loads: names, or patterns in quotes");
    option("report", report, "page to write, .html");
    option("csv", csv, "CSV file to write, a row for each trial and joint; -: standard output");
    option("title", title, "title of the page; default: the name of its file");
    option.Group("Trials");
    option("labels", labels,
           "form of the ids of trials that have no labels, such as {person}_{condition}_{trial}; "
           "of a JSON file of loads, that of its name");
    option("person", person, "label that names the person");
    option("condition", condition, "label that names the condition");
    option("list", list,
           "list of jobs: those without a result are missing; default: jobs.jsonl beside "
           "jobs.results.jsonl, if it is there");
    option.HasNoEffect("title", "without --report", [this] { return report->empty(); });
  }
};

void CheckOutputs(const StudyOptions& options) {
  if (!options.report->empty()) {
    const std::string ending = std::filesystem::path(*options.report).extension().string();
    if (ending != ".html" && ending != ".htm") {
      throw UsageError("--report=" + *options.report + ": expected a name that ends in .html");
    }
  }
  if (!options.csv->empty() && *options.csv != "-" && !options.report->empty() &&
      PlaceOfOutput(*options.csv) == PlaceOfOutput(*options.report)) {
    throw UsageError("--csv=" + *options.csv + ": the page has this name; give it another one");
  }
}

void CheckIsNoSource(const StudyOptions& options, const std::vector<std::string>& sources) {
  for (const std::string& source : sources) {
    if (!options.report->empty()) {
      CheckIsNotSource(source, *options.report, "--report=" + *options.report);
    }
    if (!options.csv->empty()) CheckIsNotSource(source, *options.csv, "--csv=" + *options.csv);
  }
}

Study Read(const StudyOptions& options) {
  StudySettings settings;
  settings.paths = *options.results;
  settings.list = *options.list;
  settings.labels = options.labels;
  settings.person = *options.person;
  settings.condition = *options.condition;
  std::mutex mutex;
  std::optional<Progress> progress;
  return ReadStudy(settings, [&](std::size_t all) {
    const std::lock_guard lock(mutex);
    if (!progress) progress.emplace("trials:", static_cast<int>(all));
    progress->Step();
  });
}

int RunStudy(const StudyOptions& options) {
  CheckOutputs(options);
  const Study study = Read(options);
  CheckIsNoSource(options, study.sources);
  for (const std::string& fault : study.faults) spdlog::error("{}", fault);
  if (study.trials.empty()) throw SourceError("the results have no job; nothing was written");
  if (!options.csv->empty()) WriteStudyCsv(study, *options.csv);
  if (!options.report->empty()) {
    const std::string title = options.title->empty()
                                  ? std::filesystem::path(*options.report).stem().string()
                                  : *options.title;
    WriteStudyPage(study, title, *options.csv, *options.report);
  }
  if (*options.csv != "-") {
    PrintText(stdout, TextOf(study));
    for (const std::string& path : {*options.report, *options.csv}) {
      if (!path.empty()) Print("{}: written\n", path);
    }
  }
  return study.failures.empty() && study.faults.empty() ? 0 : 1;
}

}  // namespace

Command StudyCommand() {
  const auto values = std::make_shared<StudyOptions>();
  Command command = CommandNamed("study");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope study 'loads.results*.jsonl' --report study.html --csv study.csv"
      "\n  kinescope study 'loads/*.json' --labels '{person}_{condition}_{trial}' --csv study.csv";
  values->List(command.options);
  command.positionals = {"results"};
  command.required = {"results"};
  command.footer =
      "Exit code: 0 all jobs are complete, 1 one is not, or a line is wrong, 2 nothing could be "
      "read.";
  command.run = [values](options::OptionList&) { return RunStudy(*values); };
  return command;
}

}  // namespace kinescope::app
