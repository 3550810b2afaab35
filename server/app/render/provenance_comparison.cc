#include "server/app/render/provenance_comparison.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "core/system/json_parse.h"

namespace kinescope::app {
namespace {

using InputName = std::pair<std::string, std::string>;  // option, name of the file

std::map<InputName, std::string> HashesOfInputs(const Json& provenance) {
  std::map<InputName, std::string> hashes;
  // Through text, so that names that are not UTF-8 are as they are after reading.
  const Json read = ParseOrderedJson(ToText(provenance));
  for (const Json& input : read.value("inputs", Json::array())) {
    const std::string option = PresentNameOf(input.value("option", ""), read.value("schema", 0));
    hashes[{option, input.value("name", "")}] = input.value("sha256", "");
  }
  return hashes;
}

void AddCorrectionsOfSchemaTwo(const Json& then, const RenderOptions& options,
                               std::vector<std::string>& clauses) {
  const bool has_former_filters = then.value("loads", Json::object()).contains("low_pass_secs");
  if (has_former_filters) {
    clauses.emplace_back(
        "load spheres were larger, and their classes and the numbers in plots came from different "
        "filters (now: --shown)");
  } else if (ToPictureSpec(options.view).look.Shows(render::ScenePart::kLoads)) {
    clauses.emplace_back("load spheres did not follow the width of the person's limbs");
  }
  if (!*options.view.no_overlays && (options.view.overlay->legend || !options.view.plot->empty())) {
    clauses.emplace_back(
        "the legend and plots called an unknown load 'no data', and the ground reaction force "
        "'force on a foot'");
  }
  if (then.value("source", Json::object()).value("name", "") == "demo:lift") {
    clauses.emplace_back("the forearms of demo:lift passed through the thighs");
  }
}

}  // namespace

bool DecideTheSame(const Json& a, const Json& b) {
  const auto decisive = [](const Json& given) {
    // Through text, so that 1.0 and 1 are what they are after reading.
    auto json = ParseJsonOrThrow(ToText(given));
    for (const char* follows : {"camera", "camera_note", "path", "pictures", "file"})
      json.erase(follows);
    return json;
  };
  return decisive(a) == decisive(b);
}

// In schema 1 inputs were guessed from the texts of options, so that some were missed and some were
// listed that decide nothing.
std::string DifferenceOfInputs(const Json& then, const Json& now) {
  const auto before = HashesOfInputs(then), after = HashesOfInputs(now);
  const bool is_guessed = then.value("schema", 0) < 2;
  const auto describe = [](const InputName& input, const std::string& how) {
    return fmt::format("an input file named in its options is missing or has changed: --{}: {}: {}",
                       input.first, input.second, how);
  };
  for (const auto& [input, hash] : before) {
    const auto found = after.find(input);
    if (found == after.end() && !is_guessed) {
      return describe(input, fmt::format("SHA-256 {} then, missing now", hash));
    }
    if (found != after.end() && found->second != hash) {
      return describe(input, fmt::format("SHA-256 {} then, {} now", hash, found->second));
    }
  }
  for (const auto& [input, hash] : after) {
    if (is_guessed || before.count(input) > 0) continue;
    return describe(input, fmt::format("not read then, SHA-256 {} now", hash));
  }
  return "";
}

std::vector<std::string> CorrectionsSince(const Json& then) {
  std::vector<std::string> clauses;
  const int schema = then.value("schema", 0);
  if (schema >= 3) return clauses;
  const RenderOptions options = OptionsOf(then, "a." + then.value("format", ""));
  AddCorrectionsOfSchemaTwo(then, options, clauses);
  if (schema >= 2) return clauses;
  if (!options.view.plot->empty() && *options.loads.class_limits != *LoadOptions().class_limits) {
    clauses.emplace_back("the bands behind --plot did not follow --class_limits");
  }
  if (options.view.ghost->kind == GhostSource::Kind::kMoment) {
    clauses.emplace_back("the ghost of a recording did not follow the options of the person");
  }
  if (then.contains("number") && DependsOnWholeClip(options.view)) {
    clauses.emplace_back(
        "a picture of a sequence did not contain the length of the sequence, on which its plot or "
        "camera depends (verify the whole sequence)");
  }
  if (then.value("format", "") == "mp4" && ToPictureSpec(options.view).width % 128 != 0) {
    clauses.emplace_back(
        "x264 used its macroblock tree also for clips whose width is not a multiple of 128, with "
        "undefined results");
  }
  return clauses;
}

}  // namespace kinescope::app
