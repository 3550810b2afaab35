// `kinescope golden check | accept | update | new | keys | list | compare`: have the pictures that
// people see changed, and what in them?
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "render/renderer.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_accept.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_compare.h"
#include "server/app/golden/golden_github.h"
#include "server/app/golden/golden_junit.h"
#include "server/app/golden/golden_new.h"
#include "server/app/golden/golden_report.h"
#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_suite.h"
#include "server/app/golden/golden_update.h"
#include "server/app/print.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"

namespace kinescope::app {
namespace {

struct GoldenOptions {
  options::Text folder{"golden_images"};
  options::Texts only;
  options::Text out{"out/golden"};
  options::Text junit, summary;
  options::Flag json, is_strict, takes_other_environment;
  options::Text run{"out/golden"}, accept_folder;
  BackendOptions backend;

  void ListCases(options::OptionList& option) {
    option("folder", folder, "folder with <case>.yaml, <case>.png and golden.lock");
    option("case", only, "cases to use; default: all");
  }
};

void PrintVerdict(const CaseVerdict& verdict) {
  const char* const how =
      verdict.outcome == Outcome::kSame && !verdict.is_byte_equal ? " (within the limits)" : "";
  Print("{:<24} {}{}\n", verdict.name, LoudName(verdict.outcome), how);
  if (verdict.outcome != Outcome::kSame && !verdict.why.empty()) {
    Print("  purpose: {}\n", verdict.why);
  }
  for (const std::string& line : Explain(verdict)) Print("  {}\n", line);
}

void PrintSummary(const OutcomeCounts& counts, const GoldenOptions& options) {
  Print("{}\n", Headline(counts));
  if (counts.ExitCode() == 0) return;
  Print("Report: {}/report.html; to accept what it shows: kinescope golden accept {} CASE...\n",
        *options.out, *options.out);
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

void WriteResults(const GoldenOptions& options, const std::vector<CaseVerdict>& verdicts) {
  const std::filesystem::path out = *options.out;
  WriteRun(out, *options.folder, verdicts);
  render::WriteNewFile(out / "report.html", GoldenReport(verdicts, {*options.folder, out}));
  if (!options.junit->empty()) {
    render::WriteNewFile(*options.junit, ToJunit(verdicts, *options.folder, out));
  }
  if (!options.summary->empty()) {
    render::WriteNewFile(*options.summary, ToMarkdown(verdicts, out));
  }
}

int CheckAll(const GoldenOptions& options) {
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  const auto renderer = StartRenderer(options.backend);
  ClearRun(*options.out);
  const GithubOutput github(*options.json);
  std::vector<CaseVerdict> verdicts;
  CheckSuite(suite, {*options.out, *options.is_strict}, *renderer, [&](const CaseVerdict& verdict) {
    verdicts.push_back(verdict);
    if (*options.json) {
      Print("{}\n", JsonText(ToJson(verdict, *options.out)));
    } else {
      PrintVerdict(verdict);
    }
  });
  const OutcomeCounts counts = CountsOf(verdicts);
  WriteResults(options, verdicts);
  if (!*options.json) PrintSummary(counts, options);
  github.End(verdicts, *options.out);
  return counts.ExitCode();
}

int AcceptAll(const GoldenOptions& options) {
  RefuseToAcceptInCi();
  return AcceptRun(
      {*options.run, *options.only, *options.accept_folder, *options.takes_other_environment});
}

int UpdateAll(const GoldenOptions& options) {
  RefuseToAcceptInCi();
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  return UpdateSuite(suite, *StartRenderer(options.backend));
}

int ListAll(const GoldenOptions& options) {
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  for (const FoundCase& found : suite.cases) {
    const bool is_accepted = suite.AcceptedOf(found) != nullptr;
    const std::string why = found.read ? *found.read->why : found.error;
    if (*options.json) {
      Print("{}\n", JsonText(nlohmann::json{{"case", found.name},
                                            {"is_accepted", is_accepted},
                                            {"is_readable", found.read.has_value()},
                                            {"why", why}}));
      continue;
    }
    Print("{:<24} {:<13}{}{}\n", found.name, is_accepted ? "accepted" : "not accepted",
          found.read ? "" : "NOT READABLE: ", why);
  }
  for (const auto& orphan : suite.orphans) {
    if (*options.json) continue;
    Print("{:<24} belongs to no case\n", orphan.string());
  }
  return 0;
}

Command CheckCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command check;
  check.name = "check";
  check.about = "Draws every case and compares it with the accepted picture";
  values->ListCases(check.options);
  values->backend.List(check.options);
  check.options("out", values->out,
                "folder for the report, the verdicts (run.json) and the pictures of cases that are "
                "not the same");
  check.options("strict", values->is_strict,
                "only equal bytes in the accepted environment are the same");
  check.options("junit", values->junit, "JUnit XML file for CI servers");
  check.options("summary", values->summary, "Markdown file, for comments and pages of jobs");
  check.options("json", values->json, "print the verdicts as JSON");
  check.positionals = {"folder", "case"};
  check.footer =
      "Exit code: 0 all are the same, 1 a case differs or a picture belongs to no case, 2 a case "
      "could not be compared.\n"
      "In GitHub Actions, it writes annotations and the summary of the job by itself.";
  check.run = [values](options::OptionList&) { return CheckAll(*values); };
  return check;
}

Command UpdateCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command update;
  update.name = "update";
  update.about = "Draws every case and accepts it as it is; writes only what has changed";
  values->ListCases(update.options);
  values->backend.List(update.options);
  update.positionals = {"folder", "case"};
  update.footer = "Exit code: 0 all are accepted, 2 a case is not. Refused where CI is set.";
  update.run = [values](options::OptionList&) { return UpdateAll(*values); };
  return update;
}

Command AcceptCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command accept;
  accept.name = "accept";
  accept.about = "Takes the new pictures of a run of golden check, without drawing them again";
  accept.options("run", values->run, "folder that golden check has left (its --out)");
  accept.options("case", values->only, "cases to take; default: all that are not the same");
  accept.options("folder", values->accept_folder, "folder of the cases; default: that of the run");
  accept.options("other_environment", values->takes_other_environment,
                 "take pictures that were drawn with another driver or font than the others");
  accept.positionals = {"run", "case"};
  accept.footer =
      "Works on another machine than the run, too: it takes a picture only if the case, its inputs "
      "and the picture accepted before are those of the run.\n"
      "Exit code: 0 all are taken, 2 one is not. Refused where CI is set.";
  accept.run = [values](options::OptionList&) { return AcceptAll(*values); };
  return accept;
}

Command ListCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command list;
  list.name = "list";
  list.about = "Lists the cases and their purposes, without drawing them";
  values->ListCases(list.options);
  list.options("json", values->json, "print the cases as JSON");
  list.positionals = {"folder", "case"};
  list.run = [values](options::OptionList&) { return ListAll(*values); };
  return list;
}

struct NewCase {
  options::Text folder{"golden_images"}, name;
  GoldenCase described;
};

int WriteCase(const NewCase& values, const options::OptionList& given) {
  options::OptionList keys = given;
  keys.Remove({"folder", "name"});
  const auto path = WriteNewCase(*values.folder, *values.name, keys);
  Print("{}\nNext: kinescope golden check {} {} draws it, and says how to accept it\n",
        path.string(), *values.folder, *values.name);
  return 0;
}

Command NewCommand() {
  const auto values = std::make_shared<NewCase>();
  Command command;
  command.name = "new";
  command.about =
      "Writes a case: what to draw, and from which recording\n"
      "  kinescope golden new golden_images lift --source=lift.mvnx --time=2.5 --camera=right";
  command.options("folder", values->folder, "folder of the cases; made if there is none");
  command.options("name", values->name, "name of the case, and of its file");
  values->described.List(command.options);
  command.positionals = {"folder", "name"};
  command.required = {"folder", "name", "source"};
  command.footer = "Paths are given from here; in the case they are relative to its file.";
  command.run = [values](options::OptionList& given) { return WriteCase(*values, given); };
  return command;
}

Command KeysCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command keys;
  keys.name = "keys";
  keys.about = "Explains every key that a case may have, with its default";
  keys.options("json", values->json, "print the keys as JSON");
  keys.run = [values](options::OptionList&) {
    PrintKeys(*values->json);
    return 0;
  };
  return keys;
}

struct CompareOptions {
  options::Text one, other, out;
  options::Flag json;
};

int Compare(const CompareOptions& options) {
  const PictureVerdict verdict = ComparePictures(*options.one, *options.other, *options.out);
  if (*options.json) {
    Print("{}\n", JsonText(ToJson(verdict)));
  } else {
    for (const std::string& line : LinesOf(verdict)) Print("{}\n", line);
  }
  return verdict.is_same ? 0 : 1;
}

Command CompareCommand() {
  const auto values = std::make_shared<CompareOptions>();
  Command compare;
  compare.name = "compare";
  compare.about = "Compares two PNG pictures by pixels, structure and light";
  compare.options("one", values->one, "the expected picture, a PNG file");
  compare.options("other", values->other, "the actual picture, a PNG file");
  compare.options("out", values->out,
                  "PNG file of the heat map, written if they differ: changed pixels in yellow to "
                  "dark purple, smoothed edges in blue");
  compare.options("json", values->json, "print the result as JSON");
  compare.positionals = {"one", "other"};
  compare.required = {"one", "other"};
  compare.footer =
      "Exit code: 0 the same pixels or the same to the eye, 1 they differ, 2 they could not be "
      "compared.";
  compare.run = [values](options::OptionList&) { return Compare(*values); };
  return compare;
}

}  // namespace

Command GoldenCommand() {
  Command command;
  command.name = "golden";
  command.about = "Compares pictures with the accepted ones";
  command.parts = {CheckCommand(), AcceptCommand(), UpdateCommand(), NewCommand(),
                   KeysCommand(),  ListCommand(),   CompareCommand()};
  return command;
}

}  // namespace kinescope::app
