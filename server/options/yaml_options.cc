#include "server/options/yaml_options.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <map>

#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/words.h"
#include "server/options/yaml_file.h"

namespace kinescope::options {

struct YamlOptions::Root {
  YAML::Node node;
};

namespace {

std::string PlaceOf(const std::string& path, const YAML::Node& node) {
  return fmt::format("{}:{}: ", path, node.Mark().line + 1);
}

}  // namespace

YamlOptions::YamlOptions(const std::string& path) : path_(path), root_(std::make_unique<Root>()) {
  Load([&] { return LoadYaml(path); });
}

YamlOptions::YamlOptions(const std::string& path, const std::string& text)
    : path_(path), root_(std::make_unique<Root>()) {
  Load([&] { return ParseYaml(text); });
}

template <class Read>
void YamlOptions::Load(const Read& read) {
  try {
    root_->node = read();
  } catch (const YAML::BadFile&) {
    throw UsageError(CannotRead(path_));
  } catch (const YAML::Exception& error) {
    throw UsageError(fmt::format("{}:{}: not valid YAML ({}); expected one 'name: value' per line",
                                 path_, error.mark.line + 1, error.msg));
  }
  if (!root_->node.IsMap()) throw UsageError(path_ + ": expected lines of 'name: value'");
}

YamlOptions::~YamlOptions() = default;

std::optional<Found> YamlOptions::LookForList(const std::string& name) const {
  const YAML::Node value = root_->node[name];
  if (!value || !value.IsSequence() || value.size() == 0) return Look(name);
  Found found{"", PlaceOf(path_, value)};
  for (const YAML::Node& each : value) {
    if (!each.IsScalar()) throw UsageError(found.origin + name + ": expected a list of values");
    found.texts.push_back(each.Scalar());
  }
  return found;
}

std::optional<Found> YamlOptions::Look(const std::string& name) const {
  const YAML::Node value = root_->node[name];
  if (!value) return std::nullopt;
  const std::string place = PlaceOf(path_, value);
  if (!value.IsScalar()) throw UsageError(place + name + ": expected one value");
  return Found{value.Scalar(), place};
}

void YamlOptions::SetAll(OptionList& options, const char* help) const {
  std::map<std::string, int> lines;
  for (const auto& entry : root_->node) {
    if (!entry.first.IsScalar()) {
      throw UsageError(PlaceOf(path_, entry.first) + "expected the name of an option before ':'");
    }
    const std::string key = entry.first.Scalar();
    const int line = entry.first.Mark().line + 1;
    const auto [first, is_new] = lines.emplace(key, line);
    if (!is_new) {
      throw UsageError(fmt::format("{}:{}: {}: given twice, first in line {}; remove one", path_,
                                   line, key, first->second));
    }
    if (options.Find(key) != nullptr) continue;
    throw UsageError(fmt::format("{}unknown option '{}'{} (see {})", PlaceOf(path_, entry.first),
                                 key, SuggestionFor(key, options.Names()), help));
  }
  const auto look = [&](const std::string& name) {
    const Option* const option = options.Find(name);
    const bool is_repeatable = option != nullptr && option->value->is_repeatable();
    return is_repeatable ? LookForList(name) : Look(name);
  };
  SetFrom(look, Channel::kFile, options);
}

}  // namespace kinescope::options
