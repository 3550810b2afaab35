#include "server/options/option_json.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/system/json_parse.h"
#include "core/system/sha256.h"

namespace kinescope::options {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

nlohmann::json ToJson(const Value& value) {
  if (!value.IsGiven()) return nullptr;
  if (value.is_repeatable()) return value.ToTexts();
  const std::string text = value.ToText();
  if (value.json_kind() == JsonKind::kText) return text;
  return ParseJsonOrThrow(text);
}

Json ValuesOf(const OptionList& list) {
  Json values = Json::object();
  for (const Option& option : list) {
    if (option.value->IsGiven()) values[option.name] = ToJson(*option.value);
  }
  return values;
}

Json InputsOf(const OptionList& list) {
  Json inputs = Json::array();
  for (const Option& option : list) {
    std::vector<fs::path> files = option.value->Files();
    std::sort(files.begin(), files.end());
    for (const fs::path& path : files) {
      std::error_code ignored;
      if (!fs::is_regular_file(path, ignored)) continue;  // its reader will say so
      const FileDigest digest = DigestOf(path);
      inputs.push_back({{"option", option.name},
                        {"name", path.filename().string()},
                        {"sha256", digest.sha256},
                        {"bytes", digest.bytes}});
    }
  }
  return inputs;
}

}  // namespace kinescope::options
