#include "server/app/golden/golden_run.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <string_view>

#include "core/system/errors.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/golden/golden_verdict_json.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kRunSchema = 1;

fs::path FileOf(const fs::path& out) { return out / "run.json"; }

// Pictures are looked for under this name: "../bend" would be one of another folder.
bool IsFileName(const std::string& name) {
  return !name.empty() && name.find_first_of(std::string_view("/\0", 2)) == std::string::npos;
}

// Of those that were drawn, which have pictures.
void CheckNames(const std::vector<CaseVerdict>& verdicts) {
  std::set<std::string> names;
  for (const CaseVerdict& verdict : verdicts) {
    if (!verdict.now) continue;
    if (!IsFileName(verdict.name)) {
      throw std::runtime_error(
          fmt::format("case '{}'; expected the name of a file, without a folder", verdict.name));
    }
    if (!names.insert(verdict.name).second) {
      throw std::runtime_error(fmt::format("case '{}' is there twice", verdict.name));
    }
  }
}

}  // namespace

void ClearRun(const fs::path& out) {
  std::error_code error;
  std::vector<fs::path> left = {FileOf(out), out / "report.html"};
  for (const auto& entry : fs::directory_iterator(out, error)) {
    const std::string name = entry.path().filename();
    for (const std::string ending : {".actual.png", ".diff.png", ".compare.png"}) {
      if (name.size() > ending.size() &&
          name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
        left.push_back(entry.path());
      }
    }
  }
  for (const fs::path& path : left) {
    fs::remove(path, error);
    if (error) throw std::runtime_error(path.string() + ": " + error.message());
  }
}

void WriteRun(const fs::path& out, const fs::path& folder,
              const std::vector<CaseVerdict>& verdicts) {
  const OutcomeCounts counts = CountsOf(verdicts);
  Json run = {{"schema", kRunSchema},           {"kinescope", KINESCOPE_VERSION},
              {"folder", folder.string()},      {"headline", Headline(counts)},
              {"exit_code", counts.ExitCode()}, {"cases", Json::array()}};
  for (const CaseVerdict& verdict : verdicts) {
    run["cases"].push_back(ToWholeJson(verdict, out));
  }
  fs::create_directories(out);
  render::WriteNewFile(FileOf(out), JsonText(run, 1) + "\n");
}

GoldenRun ParseRun(const std::string& text) {
  const json document = ParseJsonOrThrow(text);
  if (document.at("schema") != kRunSchema) {
    throw std::runtime_error(fmt::format("schema {}; this version reads {}",
                                         JsonText(document.at("schema")), kRunSchema));
  }
  GoldenRun run;
  run.folder = document.at("folder").get<std::string>();
  run.version = document.at("kinescope");
  for (const json& line : document.at("cases")) run.verdicts.push_back(VerdictFrom(line));
  CheckNames(run.verdicts);
  return run;
}

GoldenRun ReadRun(const fs::path& out) {
  const fs::path path = FileOf(out);
  try {
    return ParseRun(ReadSmallFile(path));
  } catch (const std::exception& error) {
    throw UsageError(
        fmt::format("{}: {}; name the folder that `kinescope golden check --out` has written",
                    path.string(), error.what()));
  }
}

}  // namespace kinescope::app
