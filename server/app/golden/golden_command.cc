// `kinescope golden check | update FOLDER`: have the pictures that people see changed, and what in
// them?
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/stop_signal.h"
#include "render/image/compare.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "render/renderer.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_case.h"
#include "server/app/golden/golden_objects.h"
#include "server/app/print.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

struct GoldenOptions {
  options::Text folder{"golden_images"};
  options::Texts only;
  options::Text out{"out/golden"};
  options::Flag json;
  BackendOptions backend;

  void List(options::OptionList& option) {
    option("folder", folder, "folder with <case>.yaml, .png and .objects.json");
    option("case", only, "cases to use; default: all");
    backend.List(option);
  }
};

std::vector<GoldenCase> CasesOf(const GoldenOptions& options) {
  std::vector<GoldenCase> cases = ReadGoldenCases(*options.folder);
  if (options.only->empty()) return cases;
  std::vector<GoldenCase> chosen;
  for (const std::string& name : *options.only) {
    const auto found = std::find_if(cases.begin(), cases.end(),
                                    [&](const GoldenCase& c) { return c.name == name; });
    if (found == cases.end()) {
      std::vector<std::string> known;
      known.reserve(cases.size());
      for (const GoldenCase& each : cases) known.push_back(each.name);
      const std::string suggestion = SuggestionFor(name, known);
      throw UsageError(
          fmt::format("folder '{}' contains no golden case '{}'{}", *options.folder, name,
                      suggestion.empty() ? "; write " + name + ".yaml there" : suggestion));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

fs::path ImagePath(const fs::path& folder, const GoldenCase& c) {
  return folder / (c.name + ".png");
}
fs::path ObjectsPath(const fs::path& folder, const GoldenCase& c) {
  return folder / (c.name + ".objects.json");
}

// Everything that is wrong with one case, most telling first: what it shows, then how it looks.
std::vector<std::string> Check(const GoldenOptions& options, const GoldenCase& golden_case,
                               render::Renderer& renderer) {
  const GoldenDrawing drawing = Draw(golden_case, renderer);
  std::vector<std::string> problems;
  render::Image expected;
  try {
    problems =
        FindObjectChanges(ReadObjects(ObjectsPath(*options.folder, golden_case)), drawing.spheres);
    expected = render::ReadPng(ImagePath(*options.folder, golden_case));
  } catch (const std::exception& error) {
    problems.push_back(fmt::format("{}; create it with `kinescope golden update {} {}`",
                                   error.what(), *options.folder, golden_case.name));
  }
  for (std::string& mismatch : render::FindSphereMismatches(drawing.image, drawing.spheres)) {
    problems.push_back(std::move(mismatch));
  }
  if (drawing.frame_code && !(render::ReadFrameCode(drawing.image) == drawing.frame_code)) {
    problems.push_back(fmt::format("frame code: expected sample {}, {} ms",
                                   drawing.frame_code->counter,
                                   drawing.frame_code->time_code_millis));
  }
  const render::Comparison comparison = render::Compare(expected, drawing.image);
  if (!comparison.equal()) problems.push_back(render::Describe(comparison, drawing.image));
  if (!problems.empty()) {
    fs::create_directories(*options.out);
    const fs::path base = fs::path(*options.out) / golden_case.name;
    render::WritePng(base.string() + ".actual.png", drawing.image);
    render::WritePng(base.string() + ".diff.png", render::DiffImage(expected, drawing.image));
    render::WriteNewFile(base.string() + ".objects.json", ToJson(drawing.spheres));
  }
  return problems;
}

void StopIfRequested(std::size_t finished, std::size_t all) {
  if (!StopRequested()) return;
  throw std::runtime_error(fmt::format("interrupted after {} of {} cases", finished, all));
}

int CheckAll(const GoldenOptions& options) {
  const auto renderer = StartRenderer(options.backend);
  int failed = 0;
  const std::vector<GoldenCase> cases = CasesOf(options);
  std::size_t finished = 0;
  for (const GoldenCase& golden_case : cases) {
    StopIfRequested(finished++, cases.size());
    const std::vector<std::string> problems = Check(options, golden_case, *renderer);
    failed += !problems.empty();
    if (*options.json) {
      const nlohmann::json line = {
          {"case", golden_case.name}, {"same", problems.empty()}, {"problems", problems}};
      Print("{}\n", JsonText(line));
      continue;
    }
    Print("{:<24} {}\n", golden_case.name, problems.empty() ? "same" : "DIFFERS");
    if (!problems.empty() && !golden_case.why->empty()) Print("  purpose: {}\n", *golden_case.why);
    for (const std::string& problem : problems) Print("  {}\n", problem);
  }
  if (!*options.json && failed > 0) {
    Print(
        "{} of {} differ; see {}/<case>.actual.png and .diff.png\n"
        "To accept: check the pictures, then run `kinescope golden update {} <case>`\n",
        failed, cases.size(), *options.out, *options.folder);
  }
  return failed == 0 ? 0 : 1;
}

void UpdateAll(const GoldenOptions& options) {
  const auto renderer = StartRenderer(options.backend);
  const std::vector<GoldenCase> cases = CasesOf(options);
  std::size_t finished = 0;
  for (const GoldenCase& golden_case : cases) {
    StopIfRequested(finished++, cases.size());
    const GoldenDrawing drawing = Draw(golden_case, *renderer);
    const auto wrong = render::FindSphereMismatches(drawing.image, drawing.spheres);
    if (!wrong.empty()) {
      throw std::runtime_error(
          "not updated: sphere colours in the picture do not match the load classes: " +
          golden_case.name + ": " + wrong.front());
    }
    render::WritePng(ImagePath(*options.folder, golden_case), drawing.image);
    render::WriteNewFile(ObjectsPath(*options.folder, golden_case), ToJson(drawing.spheres));
    Print("{:<24} written; check the picture\n", golden_case.name);
  }
}

}  // namespace

Command GoldenCommand() {
  const auto values = std::make_shared<GoldenOptions>();
  Command check;
  check.name = "check";
  check.about = "Draws every case and compares it with the accepted picture";
  values->List(check.options);
  check.options("out", values->out, "folder for the pictures of differing cases");
  check.options("json", values->json, "print the result as JSON");
  check.positionals = {"folder", "case"};
  check.footer = "Exit code: 0 all are the same, 1 a case differs, 2 error.";
  check.run = [values](options::OptionList&) { return CheckAll(*values); };

  Command update;
  update.name = "update";
  update.about = "Draws every case and accepts it as it is";
  values->List(update.options);
  update.positionals = {"folder", "case"};
  update.run = [values](options::OptionList&) {
    UpdateAll(*values);
    return 0;
  };

  Command command;
  command.name = "golden";
  command.about = "Compares pictures with the accepted ones";
  command.parts.push_back(std::move(check));
  command.parts.push_back(std::move(update));
  return command;
}

}  // namespace kinescope::app
