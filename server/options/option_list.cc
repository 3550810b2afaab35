#include "server/options/option_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "core/system/words.h"

namespace kinescope::options {
namespace {

// For the text, or else for the first word of one of its items.
std::string SuggestionForItems(const std::string& text, const std::vector<std::string>& names) {
  std::string suggestion = SuggestionFor(text, names);
  for (const std::string& item : SplitItems(text)) {
    if (!suggestion.empty()) break;
    const std::string word = item.substr(0, item.find_first_of(":=@"));
    if (std::count(names.begin(), names.end(), word) == 0) suggestion = SuggestionFor(word, names);
  }
  return suggestion;
}

}  // namespace

void OptionList::operator()(std::string name, Value& value, std::string help) {
  options_.push_back({std::move(name), &value, std::move(help), group_, Channel::kDefault, {}, {}});
}

void OptionList::Formerly(std::string name) { options_.back().former_name = std::move(name); }

void OptionList::Remove(const std::vector<std::string>& names) {
  const auto is_named = [&](const auto& each) {
    return std::count(names.begin(), names.end(), each.name) > 0;
  };
  options_.erase(std::remove_if(options_.begin(), options_.end(), is_named), options_.end());
  conditions_.erase(std::remove_if(conditions_.begin(), conditions_.end(), is_named),
                    conditions_.end());
}

void OptionList::HasNoEffect(const std::string& name, std::string when,
                             std::function<bool()> is_so) {
  KINESCOPE_CHECK(Find(name) != nullptr);
  conditions_.push_back({name, std::move(when), std::move(is_so)});
}

Option* OptionList::Find(const std::string& name) {
  const auto found = std::find_if(options_.begin(), options_.end(), [&](const Option& option) {
    return option.name == name || option.former_name == name;
  });
  return found == options_.end() ? nullptr : &*found;
}

std::vector<std::string> OptionList::Names() const {
  std::vector<std::string> names;
  names.reserve(options_.size());
  for (const Option& option : options_) names.push_back(option.name);
  return names;
}

void OptionList::Set(Option& option, const std::string& given_name, const Found& found,
                     Channel channel) {
  const bool is_one = found.texts.empty();
  try {
    if (is_one) {
      option.value->Parse(found.text);
    } else {
      option.value->ParseAll(found.texts);
    }
  } catch (const BadValue& error) {
    const std::string text = is_one ? found.text : fmt::format("{}", fmt::join(found.texts, ";"));
    throw UsageError(fmt::format("{}{}={}: {}{}", found.origin, given_name, text, error.what(),
                                 error.suggestion().empty()
                                     ? SuggestionForItems(text, option.value->Names())
                                     : error.suggestion()));
  }
  OnSet(option, given_name, channel, found.origin);
}

void OptionList::CheckEffects() const {
  for (const Condition& condition : conditions_) {
    const auto option = std::find_if(options_.begin(), options_.end(), [&](const Option& each) {
      return each.name == condition.name;
    });
    const bool is_given =
        option->channel == Channel::kFile || option->channel == Channel::kCommandLine;
    if (!is_given || !condition.is_so()) continue;
    throw UsageError(fmt::format("{}={}: has no effect {}", option->given_as,
                                 option->value->ToText(), condition.when));
  }
}

bool OptionList::HasEffect(const std::string& name) const {
  return std::none_of(conditions_.begin(), conditions_.end(), [&](const Condition& condition) {
    return condition.name == name && condition.is_so();
  });
}

void OptionList::OnSet(Option& option, const std::string& given_name, Channel channel,
                       const std::string& origin) {
  option.channel = channel;
  option.given_as = origin + given_name;
  if (given_name != option.name) {
    const std::string dashes = origin == "--" || origin == "~" ? origin : "";
    Warn(fmt::format(
        "{}{}: this option is now called {}{}; the next version rejects the former name", origin,
        given_name, dashes, option.name));
  }
  for (const FormerWord& word : option.value->former_words()) {
    Warn(fmt::format(
        "{}{}={}: this value is now called {}; the next version rejects the former name", origin,
        given_name, word.former, word.current));
  }
}

void OptionList::Warn(std::string warning) {
  if (std::count(warnings_.begin(), warnings_.end(), warning) == 0) {
    warnings_.push_back(std::move(warning));
  }
}

void SetFrom(const Lookup& lookup, Channel channel, OptionList& options) {
  for (Option& option : options) {
    if (option.channel > channel) continue;
    for (const std::string& name : {option.name, option.former_name}) {
      if (name.empty()) continue;
      if (const auto found = lookup(name)) {
        options.Set(option, name, *found, channel);
        break;
      }
    }
  }
}

}  // namespace kinescope::options
