#include "server/app/golden/golden_new.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/golden/golden_page.h"
#include "server/app/print.h"
#include "server/options/option_json.h"
#include "server/options/yaml_file.h"
#include "server/picture/moving_robots.h"
#include "server/source/open_source.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using options::Option;

void CheckName(const std::string& name) {
  const bool is_plain =
      !name.empty() && name.front() != '.' && name.find_first_of("/\\\n") == std::string::npos;
  if (!is_plain) {
    throw UsageError(
        fmt::format("case '{}': expected a name for a file, such as lift_front", name));
  }
}

std::string RelativeTo(const fs::path& folder, const std::string& path) {
  return fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
}

// As the case must say it: paths were given from here, and are read from there.
std::string TextFor(const Option& option, const fs::path& folder) {
  const std::string text = option.value->ToText();
  const bool is_file = (option.name == "source" && !IsSubjectUrl(text)) ||
                       (option.name == "page" && IsPageFile(text));
  return is_file ? RelativeTo(folder, text) : text;
}

options::YamlLine LineOf(const Option& option, const fs::path& folder) {
  if (option.value->is_repeatable()) return {option.name, option.value->ToTexts(), true};
  return {option.name, {TextFor(option, folder)}, false};
}

}  // namespace

fs::path WriteNewCase(const fs::path& folder, const std::string& name,
                      const options::OptionList& options) {
  CheckName(name);
  fs::path path = folder / (name + ".yaml");
  if (fs::exists(path)) {
    throw UsageError(path.string() + ": there is such a case already; choose another name");
  }
  std::vector<options::YamlLine> lines;
  for (const Option& option : options) {
    if (option.given_as.empty()) continue;
    option.value->SetFolder(RelativeTo(folder, "."));
    lines.push_back(LineOf(option, folder));
  }
  fs::create_directories(folder);
  render::WriteNewFile(path, options::ToYaml(lines));
  try {
    const GoldenCase written = LoadGoldenCase(path);
    if (!written.source->empty()) {
      SceneOptions scene;
      AddBagView(written.view, scene);
      SourceSettings settings;
      settings.bag = scene.bag;
      OpenSource(*written.source, settings);
    }
  } catch (...) {
    std::error_code ignored;
    fs::remove(path, ignored);
    throw;
  }
  return path;
}

void PrintKeys(bool as_json) {
  GoldenCase defaults;
  options::OptionList keys;
  defaults.List(keys);
  for (const Option& key : keys) {
    if (key.group == options::kHidden) continue;
    const std::string expected = key.value->Expected();
    if (as_json) {
      Print("{}\n", JsonText(nlohmann::ordered_json{{"key", key.name},
                                                    {"default", options::ToJson(*key.value)},
                                                    {"expected", expected},
                                                    {"about", key.help}}));
      continue;
    }
    const std::string value = key.value->IsGiven() ? key.value->ToText() : "";
    Print("{}: {}\n    {}{}\n", key.name, value, key.help,
          expected.empty() ? "" : " [" + expected + "]");
  }
}

}  // namespace kinescope::app
