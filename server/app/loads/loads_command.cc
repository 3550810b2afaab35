// `kinescope loads`: the loads of a whole recording as a table, CSV, JSON, plots and a report.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/not_source.h"
#include "core/system/stop_signal.h"
#include "server/app/commands.h"
#include "server/app/loads/load_files.h"
#include "server/app/loads/load_plots.h"
#include "server/app/loads/load_report.h"
#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/sensitivity.h"
#include "server/app/loads/trial_marks.h"
#include "server/app/marks_option.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/options/option_json.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"
#include "server/scene/new_samples.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "server/source/open_source.h"
#include "server/source/scheme.h"
#include "server/source/source_identity.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

struct LoadsOptions {
  options::Text source, csv, json, plots, report;
  options::Choice<Layout> layout{{{"wide", Layout::kWide}, {"long", Layout::kLong}}, Layout::kWide};
  options::Choice<bool> joints{{{"scored", false}, {"all", true}}, false};
  options::Choice<bool> columns{{{"usual", false}, {"all", true}}, false};
  options::Choice<bool> samples{{{"all", true}, {"none", false}}, true};
  options::Optional<options::Number> seconds{options::Number(0, {0, kLatestSecs, "s", true})};
  options::FilePath marks;
  PersonOptions person;
  LoadOptions loads;
  BackendOptions backend;

  bool wants_curves() const { return !plots->empty() || !report->empty() || marks.IsGiven(); }

  void List(options::OptionList& option) {
    option("source", source, "source of the people: " + RecordedSourceKinds());
    option.Group("Files");
    option("csv", csv, "CSV file to write; -: standard output");
    option("json", json, "JSON file to write, with exposure and provenance; -: standard output");
    option("layout", layout, "rows of the CSV: one per sample, or one per sample and joint");
    option(
        "joints", joints,
        "joints of CSV and JSON: those with a load ratio, or all 22 with their moments and forces");
    option("columns", columns,
           "columns of CSV and JSON: usual, or all (contacts, hands, support polygon, checks, and "
           "the second largest ratio of each joint)");
    option("samples", samples,
           "rows of the JSON: every sample, or none, for a small file that has the exposure only");
    option("plots", plots, "folder to write, with a PNG and an SVG per joint");
    option("report", report, "report to write, one A4 page per person, .html or .pdf");
    option(
        "marks", marks,
        "file of marks (--marks_file of serve): table, JSON, plots and report show them with the "
        "highest loads around them");
    option("seconds", seconds, "length of the motion to read; default: all (demo: and pose: 8 s)");
    person.List(option);
    loads.List(option);
    option.Group("Drawing");
    backend.List(option);
    option.HasNoEffect("layout", "without --csv", [this] { return csv->empty(); });
    option.HasNoEffect("samples", "without --json", [this] { return json->empty(); });
    for (const char* name : {"joints", "columns"}) {
      option.HasNoEffect(name, "without --csv or --json",
                         [this] { return csv->empty() && json->empty(); });
    }
    for (const char* name : {"backend", "draw_limit_secs"}) {
      option.HasNoEffect(name, "without --report", [this] { return report->empty(); });
    }
  }
};

// Of the person and the loads, by name; those that were not given are null.
nlohmann::json OptionsAsJson(LoadsOptions& values) {
  options::OptionList list;
  values.person.List(list);
  values.loads.List(list);
  nlohmann::json out = nlohmann::json::object();
  for (const options::Option& option : list) out[option.name] = options::ToJson(*option.value);
  return out;
}

TrialContext ContextOf(LoadsOptions& options) {
  TrialContext context;
  const std::string& source = *options.source;
  const bool is_demo = IsSubjectUrl(source);
  context.source = is_demo ? source : std::filesystem::path(source).filename().string();
  context.scene = options.report->empty() ? ToSceneOptions(options.person, options.loads)
                                          : ToShownSceneOptions(options.person, options.loads);
  context.options = OptionsAsJson(options);
  return context;
}

[[noreturn]] void Interrupted() { throw std::runtime_error("interrupted; nothing was written"); }

/// All people of a recording, read once.
class Recording {
 public:
  Recording(const LoadsOptions& options, const TrialContext& context)
      : options_(options),
        meter_(context.scene.loads.meter),
        track_(ReadTrack(options.marks, IsOfRos(*options.source))),
        length_secs_(LengthOf(options)),
        reader_(*options.source, context.scene) {
    if (!options.report->empty()) sensitivity_.emplace(context.scene, length_secs_, reader_);
    const Columns columns = {*options.joints, *options.columns};
    if (!options.csv->empty()) files_.push_back(MakeCsv(*options.csv, *options.layout, columns));
    if (!options.json->empty()) {
      files_.push_back(MakeJson(*options.json, columns, *options.samples));
    }
  }

  void Read() {
    Progress progress(
        "samples:",
        length_secs_ ? static_cast<int>(std::ceil(*length_secs_ * reader_.rate_hz())) : 0);
    while (const auto scene = reader_.Next()) {
      if (StopRequested()) Interrupted();
      if (!begin_nanos_) begin_nanos_ = scene->stamp_nanos;
      if (first_ == nullptr) first_ = scene;
      if (!IsWithinLength(*begin_nanos_, scene->stamp_nanos, length_secs_)) break;
      for (const PersonState& person : scene->people) {
        if (fresh_.IsNew(person)) Add(scene, person);
      }
      last_ = scene;
      progress.Step();
    }
    for (auto& [character, trial] : trials_) trial.Finish();
  }

  void Finish(const nlohmann::json& summary) {
    for (const auto& file : files_) file->Finish(summary);
  }

  std::vector<TrialMark> MarksOfTrial() const {
    if (last_ == nullptr) return {};
    return MarksOf(track_, *first_, *last_);
  }
  std::set<std::string> Names() const {
    std::set<std::string> names;
    for (const auto& [character, trial] : trials_) names.insert(trial.newest().name);
    return names;
  }
  double rate_hz() const { return reader_.rate_hz(); }
  const std::map<int, LoadTrial>& trials() const { return trials_; }
  /// @pre a report was requested
  std::vector<SensitivityRow> SensitivityOf(int character) const {
    return sensitivity_->RowsOf(character);
  }

 private:
  static std::optional<double> LengthOf(const LoadsOptions& options) {
    if (options.seconds) {
      CheckReach(fmt::format("--seconds={}", *options.seconds), *options.seconds, *options.source);
      return *options.seconds;
    }
    if (IsSubjectUrl(*options.source)) return kSubjectLoadsSecs;
    return std::nullopt;
  }

  void Add(const std::shared_ptr<const SceneState>& scene, const PersonState& person) {
    trials_.try_emplace(person.character, options_.wants_curves(), *begin_nanos_, meter_)
        .first->second.Add(scene, person);
    if (sensitivity_) sensitivity_->AddAsComputed(person);
    for (const auto& file : files_) file->Add(person, *begin_nanos_);
  }

  const LoadsOptions& options_;
  const loads::LoadMeter::Settings meter_;
  const marks::MarkTrack track_;
  const std::optional<double> length_secs_;
  SceneReader reader_;
  std::optional<Sensitivity> sensitivity_;  // for the report
  std::vector<std::unique_ptr<LoadFile>> files_;
  std::optional<std::int64_t> begin_nanos_;
  std::shared_ptr<const SceneState> first_, last_;
  NewSamples fresh_;
  std::map<int, LoadTrial> trials_;  // by character
};

std::vector<DeclaredOutput> OutputsOf(const LoadsOptions& options) {
  using Kind = DeclaredOutput::Kind;
  std::vector<DeclaredOutput> outputs;
  const auto add = [&](const char* option, const std::string& path, Kind kind) {
    if (!path.empty()) outputs.push_back({option, path, kind});
  };
  add("csv", *options.csv, Kind::kFile);
  add("json", *options.json, Kind::kFile);
  add("plots", *options.plots, Kind::kFolder);
  add("report", *options.report, Kind::kFile);
  return outputs;
}

void CheckOutputs(const LoadsOptions& options) {
  std::map<std::filesystem::path, std::string> taken;  // place: option as it was given
  for (const DeclaredOutput& output : OutputsOf(options)) {
    if (output.path == "-") continue;
    const std::string given = fmt::format("--{}={}", output.option, output.path);
    CheckIsNotSource(*options.source, output.path, given);
    const auto [other, is_new] = taken.insert({PlaceOfOutput(output.path), given});
    if (is_new) continue;
    throw UsageError(fmt::format("{} and {} write to the same file; give each output its own name",
                                 other->second, given));
  }
}

void CheckArguments(const LoadsOptions& options) {
  if (*options.csv == "-" && *options.json == "-") {
    throw UsageError(
        "--csv=- and --json=-: only one output can go to standard output; give the other one a "
        "file name");
  }
  CheckOutputs(options);
  if (!options.report->empty()) CheckReportName(*options.report);
}

nlohmann::json ReportOf(const Recording& recording, const TrialContext& context,
                        const SourceIdentity& identity, LoadsOptions& options) {
  options::OptionList inputs;
  options.loads.List(inputs);
  inputs("marks", options.marks, "file of marks");
  const nlohmann::json hash =
      identity.digest ? nlohmann::json(identity.digest->sha256) : nlohmann::json(nullptr);
  nlohmann::json people = nlohmann::json::array();
  for (const auto& [character, trial] : recording.trials()) {
    people.push_back(SummaryJson(SummaryOf(trial, context)));
  }
  return {{"program", "kinescope " KINESCOPE_VERSION},
          {"source", context.source},
          {"source_sha256", hash},
          {"inputs", options::InputsOf(inputs)},
          {"rate_hz", context.rate_hz},
          {"options", context.options},
          {"people", people}};
}

void PrintWritten(const LoadsOptions& options) {
  for (const options::Text* out : {&options.csv, &options.json, &options.plots, &options.report}) {
    if (!(*out)->empty()) Print("{}: written\n", **out);
  }
}

// False: there is not one load that is known.
bool Loads(LoadsOptions& options, const options::OptionList& list) {
  CheckArguments(options);
  TrialContext context = ContextOf(options);
  Recording recording(options, context);
  context.rate_hz = recording.rate_hz();
  recording.Read();
  context.marks = recording.MarksOfTrial();
  context.people = recording.Names();
  if (options.marks.IsGiven() && context.marks.empty()) {
    spdlog::warn("{}: has no mark of this recording", *options.marks);
  }
  if (recording.trials().empty()) {
    throw SourceError(*options.source + ": contains no sample of a person");
  }

  const bool has_stdout = *options.csv == "-" || *options.json == "-";
  std::optional<SourceIdentity> identity;  // takes as long as reading the source once more
  if (!options.json->empty() || !options.report->empty()) identity = IdentityOf(*options.source);
  if (!options.plots->empty()) WritePlots(recording.trials(), context, *options.plots);
  if (!options.report->empty()) {
    const auto sensitivity = [&](int character) { return recording.SensitivityOf(character); };
    WriteReport(recording.trials(), context, OriginOf(*options.source, *identity, list),
                sensitivity, options.backend, *options.report);
  }
  recording.Finish(options.json->empty() ? nlohmann::json()
                                         : ReportOf(recording, context, *identity, options));
  bool knows_anything = false;
  for (const auto& [character, trial] : recording.trials()) {
    knows_anything = knows_anything || trial.knows_anything();
    if (!has_stdout) PrintText(stdout, SummaryText(SummaryOf(trial, context)) + "\n");
  }
  if (!has_stdout) PrintWritten(options);
  if (has_stdout && !knows_anything) {
    PrintText(
        stderr,
        fmt::format(
            "kinescope: no load could be computed from {}; for the causes see the reason columns\n",
            *options.source));
  }
  return knows_anything;
}

}  // namespace

Command LoadsCommand() {
  const auto values = std::make_shared<LoadsOptions>();
  Command command = CommandNamed("loads");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope loads take.mvnx --hand_load both:10 --csv loads.csv --report report.html";
  values->List(command.options);
  command.positionals = {"source"};
  command.required = {"source"};
  command.reads = {"source"};
  command.outputs = [values] {
    CheckArguments(*values);
    return OutputsOf(*values);
  };
  command.failure = "no load is known";
  command.footer = "Exit code: 0 some loads are known, 1 none is, 2 error.";
  command.run = [values](options::OptionList& list) { return Loads(*values, list) ? 0 : 1; };
  return command;
}

}  // namespace kinescope::app
