#include "server/app/serve/option_texts.h"

#include <algorithm>
#include <sstream>

namespace kinescope::app {
namespace {

options::OptionList ListOf(PersonOptions& person, LoadOptions& loads) {
  options::OptionList list;
  person.List(list);
  loads.List(list);
  return list;
}

// Those of `given` that differ.
OptionTexts Differing(options::OptionList& given, options::OptionList& defaults) {
  OptionTexts texts;
  for (const options::Option& option : given) {
    const options::Value& value = *option.value;
    const options::Value& usual = *defaults.Find(option.name)->value;
    const bool is_usual = value.IsGiven() == usual.IsGiven() && value.ToText() == usual.ToText();
    if (!value.IsGiven() || is_usual) continue;
    if (value.is_repeatable()) {
      for (const std::string& text : value.ToTexts()) texts.emplace_back(option.name, text);
    } else {
      texts.emplace_back(option.name, value.ToText());
    }
  }
  return texts;
}

}  // namespace

OptionTexts LoadsOptionsOf(const PersonOptions& person, const LoadOptions& loads) {
  PersonOptions given_person = person, default_person;
  LoadOptions given_loads = loads, default_loads;
  options::OptionList given = ListOf(given_person, given_loads);
  options::OptionList defaults = ListOf(default_person, default_loads);
  return Differing(given, defaults);
}

OptionTexts PictureOptionsOf(const ViewOptions& view, const BackendOptions& backend) {
  ViewOptions given_view = view, default_view;
  BackendOptions given_backend = backend, default_backend;
  options::OptionList given, defaults;
  given_view.List(given);
  given_backend.List(given);
  default_view.List(defaults);
  default_backend.List(defaults);
  return Differing(given, defaults);
}

void SetOption(OptionTexts& options, const std::string& name, const std::string& value) {
  const auto known = std::find_if(options.begin(), options.end(),
                                  [&](const auto& option) { return option.first == name; });
  if (known != options.end()) {
    known->second = value;
  } else {
    options.emplace_back(name, value);
  }
}

std::string ToLines(const OptionTexts& options) {
  std::string lines;
  for (const auto& [name, value] : options) lines.append(name).append("=").append(value) += '\n';
  return lines;
}

OptionTexts OptionsFromLines(const std::string& lines) {
  PersonOptions person;
  LoadOptions loads;
  options::OptionList known = ListOf(person, loads);
  OptionTexts options;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos || known.Find(line.substr(0, sign)) == nullptr) continue;
    options.emplace_back(line.substr(0, sign), line.substr(sign + 1));
  }
  return options;
}

}  // namespace kinescope::app
