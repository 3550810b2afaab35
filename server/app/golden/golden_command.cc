// `kinescope golden check | update FOLDER`: have the pictures that people see changed, and what in
// them?
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/json_text.h"
#include "render/compare.h"
#include "render/new_file.h"
#include "render/png_file.h"
#include "render/renderer.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_case.h"
#include "server/app/golden/golden_objects.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

struct GoldenOptions {
  std::string folder = "golden_images";
  std::vector<std::string> only;
  std::string out = "out/golden";
  bool json = false;
  BackendOptions backend;
};

std::vector<GoldenCase> CasesOf(const GoldenOptions& options) {
  std::vector<GoldenCase> cases = LoadGoldenCases(options.folder);
  if (options.only.empty()) return cases;
  std::vector<GoldenCase> chosen;
  for (const std::string& name : options.only) {
    const auto found = std::find_if(cases.begin(), cases.end(),
                                    [&](const GoldenCase& c) { return c.name == name; });
    if (found == cases.end()) {
      throw UsageError(fmt::format("folder '{}' holds no case '{}'", options.folder, name));
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
        FindObjectChanges(ReadObjects(ObjectsPath(options.folder, golden_case)), drawing.spheres);
    expected = render::ReadPng(ImagePath(options.folder, golden_case));
  } catch (const std::exception& error) {
    problems.push_back(fmt::format("{} (`kinescope golden update {} {}` makes it)", error.what(),
                                   options.folder, golden_case.name));
  }
  for (std::string& mismatch : render::FindSphereMismatches(drawing.image, drawing.spheres)) {
    problems.push_back(std::move(mismatch));
  }
  if (drawing.strip && !(render::ReadStrip(drawing.image) == drawing.strip)) {
    problems.push_back(fmt::format("its strip does not say sample {}, {} ms",
                                   drawing.strip->counter, drawing.strip->time_code_millis));
  }
  const render::Comparison comparison = render::Compare(expected, drawing.image);
  if (!comparison.equal()) problems.push_back(render::Describe(comparison, drawing.image));
  if (!problems.empty()) {
    fs::create_directories(options.out);
    const fs::path base = fs::path(options.out) / golden_case.name;
    render::WritePng(base.string() + ".actual.png", drawing.image);
    render::WritePng(base.string() + ".diff.png", render::DiffImage(expected, drawing.image));
    render::WriteNewFile(base.string() + ".objects.json", ToJson(drawing.spheres));
  }
  return problems;
}

int CheckAll(const GoldenOptions& options) {
  const auto renderer = StartRenderer(options.backend);
  nlohmann::json report = nlohmann::json::array();
  int failed = 0;
  const std::vector<GoldenCase> cases = CasesOf(options);
  for (const GoldenCase& golden_case : cases) {
    const std::vector<std::string> problems = Check(options, golden_case, *renderer);
    failed += !problems.empty();
    report.push_back({{"case", golden_case.name}, {"problems", problems}});
    if (options.json) continue;
    fmt::print("{:<24} {}\n", golden_case.name, problems.empty() ? "same" : "DIFFERS");
    if (!problems.empty() && !golden_case.why.empty())
      fmt::print("  it is there because {}\n", golden_case.why);
    for (const std::string& problem : problems) fmt::print("  {}\n", problem);
  }
  if (options.json) {
    fmt::print("{}\n", JsonText(report, 2));
  } else if (failed > 0) {
    fmt::print(
        "{} of {} differ; see {}/<case>.actual.png and .diff.png\n"
        "To accept: look at them, then `kinescope golden update {} <case>`\n",
        failed, cases.size(), options.out, options.folder);
  }
  return failed == 0 ? 0 : 1;
}

void UpdateAll(const GoldenOptions& options) {
  const auto renderer = StartRenderer(options.backend);
  for (const GoldenCase& golden_case : CasesOf(options)) {
    const GoldenDrawing drawing = Draw(golden_case, *renderer);
    const auto wrong = render::FindSphereMismatches(drawing.image, drawing.spheres);
    if (!wrong.empty()) {
      throw std::runtime_error("not accepted, the picture contradicts the state: " +
                               golden_case.name + ": " + wrong.front());
    }
    render::WritePng(ImagePath(options.folder, golden_case), drawing.image);
    render::WriteNewFile(ObjectsPath(options.folder, golden_case), ToJson(drawing.spheres));
    fmt::print("{:<24} written; look at it\n", golden_case.name);
  }
}

}  // namespace

void AddGolden(CommandLine line) {
  CLI::App* command = line.app.add_subcommand("golden", "Compare pictures with the accepted ones");
  command->require_subcommand(1);
  const auto o = std::make_shared<GoldenOptions>();
  const auto add_places = [&](CLI::App* part) {
    part->add_option("folder", o->folder, "holds <case>.yaml, .png and .objects.json")
        ->capture_default_str();
    part->add_option("case", o->only, "only these");
    o->backend.Visit(FlagAdder(*part));
  };
  CLI::App* check =
      command->add_subcommand("check", "Draw every case and compare; exit code 1 if any differs");
  add_places(check);
  check->add_option("--out", o->out, "where the pictures of differing cases go")
      ->capture_default_str();
  check->add_flag("--json", o->json, "tell the result as JSON");
  int& exit_code = line.exit_code;
  check->callback([o, &exit_code] { exit_code = CheckAll(*o); });

  CLI::App* update = command->add_subcommand("update", "Draw every case and accept it as it is");
  add_places(update);
  update->callback([o] { UpdateAll(*o); });
}

}  // namespace kinescope::app
