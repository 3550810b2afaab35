/// Fills an options struct (options.h) from its three channels: a YAML file, ROS private
/// parameters, the command line. The later wins. Names are the same everywhere.
#pragma once

#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace kinescope::app {

template <class T>
struct OptionalOf : std::false_type {
  using Value = T;
};
template <class T>
struct OptionalOf<std::optional<T>> : std::true_type {
  using Value = T;
};

/// `text` as a T, which may be optional or a list with ; between. @throws UsageError naming option,
/// value and what was expected.
template <class T>
T ParseOption(const std::string& name, const std::string& text) {
  if constexpr (std::is_same_v<T, std::vector<std::string>>) {  // several, with ; between
    T list;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ';');) list.push_back(part);
    return list;
  } else {
    typename OptionalOf<T>::Value value{};
    using Value = decltype(value);
    const auto refuse = [&](const char* expected) {
      throw UsageError(name + "=" + text + ": expected " + expected);
    };
    if constexpr (std::is_same_v<Value, std::string>) {
      value = text;
    } else if constexpr (std::is_same_v<Value, bool>) {
      if (text != "true" && text != "false" && text != "1" && text != "0") refuse("true or false");
      value = text == "true" || text == "1";
    } else {
      if (!CLI::detail::lexical_cast(text, value)) {
        refuse(std::is_integral_v<Value> ? "a whole number" : "a number");
      }
    }
    return value;
  }
}

/// One --flag for each option. Bools become --flag / --flag=false. The option called `positional`
/// may also be given without its flag.
class FlagAdder {
 public:
  explicit FlagAdder(CLI::App& command, std::string positional = {})
      : command_(command), positional_(std::move(positional)) {}

  template <class T>
  void operator()(const std::string& name, T& value, const std::string& help) {
    if constexpr (std::is_same_v<T, bool>) {
      command_.add_flag("--" + name, value, help);
    } else {
      const std::string names = "--" + name + (name == positional_ ? "," + name : "");
      CLI::Option* option = command_.add_option(names, value, help);
      if constexpr (std::is_same_v<T, std::vector<std::string>>) {
        option->allow_extra_args(false);  // one each time it is said
      } else if constexpr (!OptionalOf<T>::value) {
        option->capture_default_str();
      }
    }
  }

 private:
  CLI::App& command_;
  std::string positional_;
};

/// Values from elsewhere, for options that the command line did not set. Without a `command`: for
/// all.
class ValueSetter {
 public:
  using Lookup = std::function<std::optional<std::string>(const std::string& name)>;

  ValueSetter(const CLI::App& command, Lookup lookup)
      : command_(&command), lookup_(std::move(lookup)) {}
  explicit ValueSetter(Lookup lookup) : lookup_(std::move(lookup)) {}

  template <class T>
  void operator()(const std::string& name, T& value, const std::string& = {}) {
    names_.insert(name);
    if (command_ != nullptr && command_->count("--" + name) > 0) return;
    if (const auto text = lookup_(name)) value = ParseOption<T>(name, *text);
  }

  /// The options that exist, once visited.
  const std::set<std::string>& names() const { return names_; }

 private:
  const CLI::App* command_ = nullptr;
  Lookup lookup_;
  std::set<std::string> names_;
};

/// A YAML map `name: value` as a lookup. @throws UsageError naming file, line and reason.
class YamlValues {
 public:
  explicit YamlValues(const std::string& path);
  std::optional<std::string> operator()(const std::string& name) const;
  /// @throws UsageError naming the first key that is not among `known`.
  void RefuseUnknown(const std::set<std::string>& known) const;

 private:
  std::string path_;
  YAML::Node root_;
};

}  // namespace kinescope::app
