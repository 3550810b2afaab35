// `kinescope loads`: the loads of a whole recording as a table, CSV, JSON, plots and a report.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/clocks.h"
#include "core/stop_signal.h"
#include "server/app/commands.h"
#include "server/app/loads/load_figures.h"
#include "server/app/loads/load_files.h"
#include "server/app/loads/load_report.h"
#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/app/progress.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

struct LoadsOptions {
  std::string source;
  std::string csv, json, plots, report;
  std::string layout = "wide";
  std::optional<double> seconds;
  PersonOptions person;
  LoadOptions loads;
  BackendOptions backend;

  bool wants_figures() const { return !plots.empty() || !report.empty(); }
};

// An endless source (the built-in subject) is read this long unless told otherwise: one lift.
constexpr double kDefaultSecs = 8;

// Every option of a list, by name.
class OptionJson {
 public:
  explicit OptionJson(nlohmann::json& out) : out_(out) {}
  template <class T>
  void operator()(const std::string& name, const T& value, const std::string&) {
    out_[name] = value;
  }
  template <class T>
  void operator()(const std::string& name, const std::optional<T>& value, const std::string&) {
    out_[name] = value ? nlohmann::json(*value) : nlohmann::json(nullptr);
  }

 private:
  nlohmann::json& out_;
};

TrialContext ContextOf(LoadsOptions& options) {
  TrialContext context;
  const bool is_demo = options.source.rfind("demo:", 0) == 0;
  context.source =
      is_demo ? options.source : std::filesystem::path(options.source).filename().string();
  context.scene = ToSceneOptions(options.person, SceneOptions().stale_secs, options.loads);
  context.options = nlohmann::json::object();
  options.person.Visit(OptionJson(context.options));
  options.loads.Visit(OptionJson(context.options));
  return context;
}

Layout ToLayout(const std::string& text) {
  if (text == "wide") return Layout::kWide;
  if (text == "long") return Layout::kLong;
  throw UsageError(fmt::format("--layout={}: expected wide or long", text));
}

[[noreturn]] void Interrupted() { throw std::runtime_error("interrupted; nothing was written"); }

/// All people of a recording, read once.
class Recording {
 public:
  Recording(const LoadsOptions& options, const TrialContext& context)
      : options_(options), reader_(options.source, context.scene) {
    if (!options.csv.empty()) files_.push_back(MakeCsv(options.csv, ToLayout(options.layout)));
    if (!options.json.empty()) files_.push_back(MakeJson(options.json));
  }

  void Read() {
    std::optional<double> length = options_.seconds;
    if (!length && options_.source.rfind("demo:", 0) == 0) length = kDefaultSecs;
    Progress progress("samples:",
                      length ? static_cast<int>(std::ceil(*length * reader_.rate_hz())) : 0);
    while (const auto scene = reader_.Next()) {
      if (StopRequested()) Interrupted();
      if (!begin_nanos_) begin_nanos_ = scene->stamp_nanos;
      const double secs = Secs(scene->stamp_nanos - *begin_nanos_);
      // A hair, so that rounded stamps do not decide; the last sample is the one at the end.
      if (length && secs > *length + 1e-6) break;
      for (const PersonState& person : scene->people) AddIfNew(scene, person);
      progress.Step();
    }
  }

  void Finish(const nlohmann::json& summary) {
    for (const auto& file : files_) file->Finish(summary);
  }

  double rate_hz() const { return reader_.rate_hz(); }
  const std::map<int, LoadTrial>& trials() const { return trials_; }

 private:
  // A scene has everybody; only one of them has just moved.
  void AddIfNew(const std::shared_ptr<const SceneState>& scene, const PersonState& person) {
    const auto [found, is_first] =
        trials_.try_emplace(person.character, options_.wants_figures(), *begin_nanos_);
    LoadTrial& trial = found->second;
    if (!is_first && trial.newest().sample.stamp_nanos == person.sample.stamp_nanos &&
        trial.newest().sample.counter == person.sample.counter) {
      return;
    }
    trial.Add(scene, person);
    for (const auto& file : files_) file->Add(person, *begin_nanos_);
  }

  const LoadsOptions& options_;
  SceneReader reader_;
  std::vector<std::unique_ptr<LoadFile>> files_;
  std::optional<std::int64_t> begin_nanos_;
  std::map<int, LoadTrial> trials_;  // by character
};

// The same for the same file, however it is spelt.
std::filesystem::path PlaceOfOutput(const std::string& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path);
  auto place = std::filesystem::weakly_canonical(absolute, error);
  if (error) place = absolute.lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

void CheckOutputsDiffer(const LoadsOptions& options) {
  const auto unless_stdout = [](const std::string& path) { return path == "-" ? "" : path; };
  const std::pair<const char*, std::string> outputs[] = {{"csv", unless_stdout(options.csv)},
                                                         {"json", unless_stdout(options.json)},
                                                         {"report", options.report},
                                                         {"plots", options.plots}};
  std::map<std::filesystem::path, std::string> taken;  // place: option as it was given
  for (const auto& [name, path] : outputs) {
    if (path.empty()) continue;
    const std::string given = fmt::format("--{}={}", name, path);
    const auto [other, is_new] = taken.insert({PlaceOfOutput(path), given});
    if (is_new) continue;
    throw UsageError(fmt::format("{} and {}: one file for two outputs; give each a name of its own",
                                 other->second, given));
  }
}

void CheckArguments(const LoadsOptions& options) {
  if (options.seconds && !(*options.seconds > 0 && *options.seconds <= 1e6)) {
    throw UsageError(fmt::format("--seconds={}: expected more than 0", *options.seconds));
  }
  ToLayout(options.layout);
  if (options.csv == "-" && options.json == "-") {
    throw UsageError("--csv=- and --json=-: only one of them fits on standard output");
  }
  CheckOutputsDiffer(options);
}

nlohmann::json SummaryOf(const Recording& recording, const TrialContext& context) {
  nlohmann::json people = nlohmann::json::array();
  for (const auto& [character, trial] : recording.trials()) {
    people.push_back(SummaryJson(trial, context));
  }
  return {{"program", "kinescope " KINESCOPE_VERSION},
          {"source", context.source},
          {"rate_hz", context.rate_hz},
          {"options", context.options},
          {"people", people}};
}

// False: there is not one load that is known.
bool Loads(LoadsOptions& options) {
  CheckArguments(options);
  TrialContext context = ContextOf(options);
  Recording recording(options, context);
  context.rate_hz = recording.rate_hz();
  recording.Read();
  if (recording.trials().empty()) throw SourceError(options.source + " has no sample of a person");

  const bool has_stdout = options.csv == "-" || options.json == "-";
  if (!options.plots.empty()) WritePlots(recording.trials(), context, options.plots);
  if (!options.report.empty()) {
    WriteReport(recording.trials(), context, options.backend, options.report);
  }
  recording.Finish(SummaryOf(recording, context));
  bool knows_anything = false;
  for (const auto& [character, trial] : recording.trials()) {
    knows_anything = knows_anything || trial.knows_anything();
    if (!has_stdout) fmt::print("{}\n", SummaryText(trial, context));
  }
  if (has_stdout && !knows_anything) {
    fmt::print(stderr, "kinescope: no load in {} is known; why is in the columns called reason\n",
               options.source);
  }
  return knows_anything;
}

}  // namespace

void AddLoads(CommandLine line) {
  CLI::App* command =
      line.app.add_subcommand("loads", "Joint loads of a recording: table, CSV, plots, report");
  const auto o = std::make_shared<LoadsOptions>();
  command->add_option("source", o->source, kSourceKinds)->required();
  command->add_option("--csv", o->csv, "file to write; -: standard output");
  command->add_option("--json", o->json, "likewise, with exposure and provenance");
  command
      ->add_option("--layout", o->layout,
                   "of the CSV: wide (a row a sample) or long (a row a sample and joint)")
      ->capture_default_str();
  command->add_option("--plots", o->plots, "folder for PNG and SVG of every joint");
  command->add_option("--report", o->report, "one-page report to write, .html");
  command->add_option("--seconds", o->seconds, "no more than this; default: all (demo: 8)");
  o->person.Visit(FlagAdder(*command));
  o->loads.Visit(FlagAdder(*command));
  o->backend.Visit(FlagAdder(*command));
  command->callback([o, line] { line.exit_code = Loads(*o) ? 0 : 1; });
}

}  // namespace kinescope::app
