#include "server/app/golden/golden_verdict_json.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/picture_limits.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "server/app/golden/golden_check.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMostLines = 1'000'000;

Json ToJson(const GoldenFinding& finding) {
  Json line = {{"kind", Name(finding.kind)}, {"object", finding.object}};
  if (!finding.expected.empty()) line["expected"] = finding.expected;
  if (!finding.actual.empty()) line["found"] = finding.actual;
  if (finding.amount != 0) line["amount"] = finding.amount;
  if (finding.x_px) line["x"] = std::round(10 * *finding.x_px) / 10;
  if (finding.y_px) line["y"] = std::round(10 * *finding.y_px) / 10;
  line["text"] = finding.text;
  return line;
}

std::optional<double> NumberIn(const json& line, const char* name) {
  if (!line.contains(name)) return std::nullopt;
  return line.at(name).get<double>();
}

GoldenFinding FindingFrom(const json& line) {
  GoldenFinding finding;
  finding.kind = FindingKindNamed(line.at("kind").get<std::string>());
  finding.object = line.at("object");
  finding.expected = line.value("expected", "");
  finding.actual = line.value("found", "");
  finding.amount = NumberIn(line, "amount").value_or(0);
  finding.x_px = NumberIn(line, "x");
  finding.y_px = NumberIn(line, "y");
  finding.text = line.at("text");
  return finding;
}

Json ToJson(const render::Tile& box) {
  return {{"x", box.x}, {"y", box.y}, {"width", box.width}, {"height", box.height}};
}

render::Tile BoxFrom(const json& box) {
  const auto side = [&](const char* name) {
    return static_cast<int>(CountFrom(box.at(name), kMaxPictureSide));
  };
  return {side("x"), side("y"), side("width"), side("height")};
}

Json PathIfThere(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) ? Json(path.string()) : Json(nullptr);
}

Json FrameJson(const std::optional<GoldenFrame>& frame) {
  if (!frame) return nullptr;
  return {{"number", frame->number}, {"seconds", frame->secs}};
}

std::optional<GoldenFrame> FrameFrom(const json& frame) {
  if (frame.is_null()) return std::nullopt;
  return GoldenFrame{static_cast<long>(CountFrom(frame.at("number"), kMostLines)),
                     frame.at("seconds").get<double>()};
}

Outcome OutcomeNamed(const std::string& name) {
  for (const Outcome outcome : {Outcome::kSame, Outcome::kDiffers, Outcome::kNotCompared}) {
    if (name == Name(outcome)) return outcome;
  }
  throw std::runtime_error(
      fmt::format("outcome '{}': expected same, differs or not compared", name));
}

}  // namespace

Json ToJson(const CaseVerdict& verdict, const fs::path& out) {
  Json line = {{"case", verdict.name},
               {"frame", FrameJson(verdict.frame)},
               {"why", verdict.why},
               {"file", verdict.file.string()},
               {"line", verdict.line},
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
    line["layers"].push_back({{"name", layer.name},
                              {"found", layer.found},
                              {"passes", layer.passes},
                              {"numbers", layer.numbers}});
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

Json ToWholeJson(const CaseVerdict& verdict, const fs::path& out) {
  Json line = ToJson(verdict, out);
  line["masks"] = Json::array();
  for (const render::Tile& mask : verdict.masks) line["masks"].push_back(ToJson(mask));
  line["accepted_pixels"] = verdict.accepted_pixels;
  line["now"] = verdict.now ? ParseOrderedJson(ToJson(*verdict.now)) : Json(nullptr);
  return line;
}

CaseVerdict VerdictFrom(const json& line) {
  CaseVerdict verdict;
  verdict.name = line.at("case");
  verdict.frame = FrameFrom(line.at("frame"));
  verdict.why = line.at("why");
  verdict.file = line.at("file").get<std::string>();
  verdict.line = static_cast<int>(CountFrom(line.at("line"), kMostLines));
  verdict.outcome = OutcomeNamed(line.at("outcome"));
  verdict.is_byte_equal = line.at("byte_equal");
  verdict.secs = line.at("seconds");
  for (const json& finding : line.at("findings")) {
    verdict.findings.push_back(FindingFrom(finding));
  }
  for (const json& layer : line.at("layers")) {
    verdict.layers.push_back(
        {layer.at("name"), layer.at("found"), layer.at("passes"), layer.value("numbers", json())});
  }
  const json& changes = line.at("changes");
  changes.at("case").get_to(verdict.changes.options);
  changes.at("inputs").get_to(verdict.changes.inputs);
  changes.at("environment").get_to(verdict.changes.environment);
  verdict.reason = line.at("reason");
  line.at("notes").get_to(verdict.notes);
  for (const json& mask : line.at("masks")) verdict.masks.push_back(BoxFrom(mask));
  verdict.accepted_pixels = line.at("accepted_pixels");
  if (!line.at("now").is_null()) verdict.now = AcceptedFrom(line.at("now"));
  verdict.changes.is_page = verdict.now && IsForeignPage(*verdict.now);
  return verdict;
}

}  // namespace kinescope::app
