#include "server/app/golden/golden_run.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <string_view>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/golden/golden_check.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using nlohmann::json;

constexpr int kRunSchema = 1;

fs::path FileOf(const fs::path& out) { return out / "run.json"; }

Json ToJson(const GoldenFinding& finding) {
  Json line = {{"kind", Name(finding.kind)}, {"object", finding.object}};
  if (!finding.expected.empty()) line["expected"] = finding.expected;
  if (!finding.actual.empty()) line["found"] = finding.actual;
  if (finding.amount != 0) line["amount"] = finding.amount;
  if (finding.x_px && finding.y_px) {
    line["x"] = *finding.x_px;
    line["y"] = *finding.y_px;
  }
  line["text"] = finding.text;
  return line;
}

Json PathIfThere(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) ? Json(path.string()) : Json(nullptr);
}

// Pictures are looked for under this name: "../bend" would be one of another folder.
bool IsFileName(const std::string& name) {
  return !name.empty() && name.find_first_of(std::string_view("/\0", 2)) == std::string::npos;
}

Outcome OutcomeFrom(const std::string& name) {
  for (const Outcome outcome : {Outcome::kSame, Outcome::kDiffers, Outcome::kNotCompared}) {
    if (name == Name(outcome)) return outcome;
  }
  throw std::runtime_error(
      fmt::format("outcome '{}'; expected same, differs or not compared", name));
}

GoldenFinding FindingFrom(const json& line) {
  GoldenFinding finding;
  const std::string kind = line.at("kind");
  const auto known = FindingKindFrom(kind);
  if (!known) throw std::runtime_error(fmt::format("finding of an unknown kind '{}'", kind));
  finding.kind = *known;
  finding.object = line.at("object");
  finding.expected = line.value("expected", "");
  finding.actual = line.value("found", "");
  finding.amount = line.value("amount", 0.0);
  finding.text = line.at("text");
  if (!line.contains("x")) return finding;
  finding.x_px = line.at("x").get<double>();
  finding.y_px = line.at("y").get<double>();
  return finding;
}

CaseVerdict VerdictFrom(const json& line) {
  CaseVerdict read;
  read.name = line.at("case");
  read.why = line.at("why");
  read.file = line.at("file").get<std::string>();
  read.outcome = OutcomeFrom(line.at("outcome"));
  read.reason = line.at("reason");
  read.notes = line.at("notes").get<std::vector<std::string>>();
  read.is_byte_equal = line.at("byte_equal");
  read.secs = line.at("seconds");
  for (const json& each : line.at("findings")) read.findings.push_back(FindingFrom(each));
  for (const json& each : line.at("layers")) {
    read.layers.push_back({each.at("name"), each.at("found"), each.at("passes")});
  }
  const json& changes = line.at("changes");
  changes.at("case").get_to(read.changes.options);
  changes.at("inputs").get_to(read.changes.inputs);
  changes.at("environment").get_to(read.changes.environment);
  read.accepted_pixels = line.at("accepted_pixels");
  if (!line.at("now").is_null()) read.now = AcceptedFrom(line.at("now"));
  return read;
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

Json ToJson(const CaseVerdict& verdict, const fs::path& out) {
  Json line = {{"case", verdict.name},
               {"why", verdict.why},
               {"file", verdict.file.string()},
               {"outcome", Name(verdict.outcome)},
               {"same", verdict.outcome == Outcome::kSame},
               {"byte_equal", verdict.is_byte_equal},
               {"problems", Explain(verdict)},
               {"reason", verdict.reason},
               {"notes", verdict.notes},
               {"seconds", verdict.secs}};
  line["findings"] = Json::array();
  for (const GoldenFinding& finding : verdict.findings) line["findings"].push_back(ToJson(finding));
  line["layers"] = Json::array();
  for (const GoldenLayer& layer : verdict.layers) {
    line["layers"].push_back(
        {{"name", layer.name}, {"found", layer.found}, {"passes", layer.passes}});
  }
  line["cause"] = HasCause(verdict) ? Json(CauseOf(verdict.changes)) : Json(nullptr);
  line["changes"] = {{"case", verdict.changes.options},
                     {"inputs", verdict.changes.inputs},
                     {"environment", verdict.changes.environment}};
  line["picture"] = PathIfThere(NewPictureOf(out, verdict.name));
  line["difference"] = PathIfThere(DifferenceOf(out, verdict.name));
  line["comparison"] = PathIfThere(CompositeOf(out, verdict.name));
  return line;
}

void ClearRun(const fs::path& out) {
  std::error_code error;
  std::vector<fs::path> left = {FileOf(out)};
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
    Json line = ToJson(verdict, out);
    line["accepted_pixels"] = verdict.accepted_pixels;
    line["now"] = verdict.now ? Json::parse(ToJson(*verdict.now)) : Json(nullptr);
    run["cases"].push_back(std::move(line));
  }
  fs::create_directories(out);
  render::WriteNewFile(FileOf(out), JsonText(run, 1) + "\n");
}

GoldenRun ParseRun(const std::string& text) {
  const json document = json::parse(text);
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
