#include "server/picture/option_json.h"

#include <nlohmann/json.hpp>
#include <string>

namespace kinescope::app {

nlohmann::json ToJson(const options::Value& value) {
  if (!value.IsGiven()) return nullptr;
  if (value.is_repeatable()) return value.ToTexts();
  const std::string text = value.ToText();
  if (value.json_kind() == options::JsonKind::kText) return text;
  return nlohmann::json::parse(text);
}

}  // namespace kinescope::app
