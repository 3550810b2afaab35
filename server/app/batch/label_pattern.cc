#include "server/app/batch/label_pattern.h"

#include <cctype>
#include <set>

namespace kinescope::app {
namespace {

bool IsName(const std::string& text) {
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') return false;
  }
  return !text.empty();
}

}  // namespace

void LabelPattern::Parse(const std::string& text) {
  std::vector<Part> parts;
  std::set<std::string> names;
  std::size_t at = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) RefuseText();
    Part part = {text.substr(at, open - at), text.substr(open + 1, close - open - 1)};
    const bool touches = !parts.empty() && part.before.empty();  // where would the first one end?
    if (touches || !IsName(part.label) || !names.insert(part.label).second) RefuseText();
    parts.push_back(std::move(part));
    at = close + 1;
  }
  if (parts.empty()) RefuseText();
  parts.push_back({text.substr(at), ""});
  text_ = text;
  parts_ = std::move(parts);
}

std::string LabelPattern::Expected() const {
  return "names in braces with text between them, such as {person}_{condition}_{trial}";
}

std::optional<std::map<std::string, std::string>> LabelPattern::Of(const std::string& name) const {
  std::map<std::string, std::string> labels;
  if (name.compare(0, parts_.front().before.size(), parts_.front().before) != 0) {
    return std::nullopt;
  }
  std::size_t at = parts_.front().before.size();
  for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
    const std::string& after = parts_[i + 1].before;
    const bool is_last = i + 2 == parts_.size();
    std::size_t end = name.find(after, at);
    if (is_last) end = name.size() < after.size() ? std::string::npos : name.size() - after.size();
    if (end == std::string::npos || end <= at || name.compare(end, after.size(), after) != 0) {
      return std::nullopt;
    }
    labels[parts_[i].label] = name.substr(at, end - at);
    at = end + after.size();
  }
  return labels;
}

}  // namespace kinescope::app
