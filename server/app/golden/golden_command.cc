// `kinescope golden check | update | list | compare`: have the pictures that people see changed,
// and what in them?
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "render/renderer.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_compare.h"
#include "server/app/golden/golden_junit.h"
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
  options::Text junit;
  options::Flag json;
  BackendOptions backend;

  void ListCases(options::OptionList& option) {
    option("folder", folder, "folder with <case>.yaml, .png and .objects.json");
    option("case", only, "cases to use; default: all");
  }
};

std::string ToJson(const CaseVerdict& verdict) {
  return JsonText(nlohmann::json{{"case", verdict.name},
                                 {"same", verdict.outcome == Outcome::kSame},
                                 {"outcome", Name(verdict.outcome)},
                                 {"problems", verdict.problems},
                                 {"seconds", verdict.secs}});
}

const char* LoudName(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: return "same";
    case Outcome::kDiffers: return "DIFFERS";
    case Outcome::kNotCompared: break;
  }
  return "NOT COMPARED";
}

void PrintVerdict(const CaseVerdict& verdict) {
  Print("{:<24} {}\n", verdict.name, LoudName(verdict.outcome));
  if (verdict.outcome != Outcome::kSame && !verdict.why.empty()) {
    Print("  purpose: {}\n", verdict.why);
  }
  for (const std::string& problem : verdict.problems) Print("  {}\n", problem);
}

void PrintSummary(const OutcomeCounts& counts, const GoldenOptions& options) {
  if (counts.ExitCode() == 0) return;
  Print("{} same, {} differ, {} not compared; see {}/<case>.actual.png and .diff.png\n",
        counts.same, counts.different, counts.not_compared, *options.out);
  if (counts.different == 0) return;
  Print("To accept: check the pictures, then run `kinescope golden update {} <case>`\n",
        *options.folder);
}

int CheckAll(const GoldenOptions& options) {
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  const auto renderer = StartRenderer(options.backend);
  OutcomeCounts counts;
  std::vector<CaseVerdict> verdicts;
  CheckSuite(suite, {*options.out}, *renderer, [&](const CaseVerdict& verdict) {
    counts.Add(verdict.outcome);
    verdicts.push_back(verdict);
    if (*options.json) {
      Print("{}\n", ToJson(verdict));
    } else {
      PrintVerdict(verdict);
    }
  });
  if (!options.junit->empty()) {
    render::WriteNewFile(*options.junit, ToJunit(verdicts, *options.folder, *options.out));
  }
  if (!*options.json) PrintSummary(counts, options);
  return counts.ExitCode();
}

int UpdateAll(const GoldenOptions& options) {
  RefuseToAcceptInCi();
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  return UpdateSuite(suite, *StartRenderer(options.backend));
}

int ListAll(const GoldenOptions& options) {
  const GoldenSuite suite = FindGoldenSuite(*options.folder, *options.only);
  for (const FoundCase& found : suite.cases) {
    const bool is_accepted = std::filesystem::exists(suite.PictureOf(found));
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
  check.options("out", values->out, "folder for the pictures of cases that are not the same");
  check.options("junit", values->junit, "JUnit XML file for CI servers");
  check.options("json", values->json, "print the verdicts as JSON");
  check.positionals = {"folder", "case"};
  check.footer =
      "Exit code: 0 all are the same, 1 a case differs or a picture belongs to no case, 2 a case "
      "could not be compared.";
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
  command.parts = {CheckCommand(), UpdateCommand(), ListCommand(), CompareCommand()};
  return command;
}

}  // namespace kinescope::app
