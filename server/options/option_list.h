/// The options of a command, one list for the command line, YAML files, ROS parameters, --help and
/// provenance. A list refers to the values, which stay where they are. One thread.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/options/value.h"

namespace kinescope::options {

/// The group of options that --help does not show.
inline constexpr char kHidden[] = "hidden";

/// Where a value came from; the later wins.
enum class Channel { kDefault, kFile, kParameter, kCommandLine };

struct Option {
  std::string name;
  Value* value;
  std::string help;
  std::string group;  // its heading in --help
  Channel channel = Channel::kDefault;
  std::string former_name;  // accepted with a warning, for one version; "": none
  std::string given_as;     // "--mass", "~mass" or "file.yaml:3: mass"; "": not given
};

/// A value as it was given.
struct Found {
  std::string text;
  std::string origin = "--";  // stands before the name in an error: "--", "~" or "file.yaml:3: "
  /// Of a repeatable option, each text as it was given; `text` is then not used.
  std::vector<std::string> texts = {};
};

class OptionList {
 public:
  /// The heading of the options that follow.
  void Group(std::string heading) { group_ = std::move(heading); }
  void operator()(std::string name, Value& value, std::string help);
  /// Accepts `name`, too, for the option added last. @pre there is one
  void Formerly(std::string name);
  /// Leaves out what a shared list has added, but this command cannot use.
  void Remove(const std::vector<std::string>& names);
  /// `name` does nothing while `is_so`, which looks at other values: CheckEffects() then rejects
  /// it. `when`: "without --trail", "with --pictures=off". @pre there is an option of that name
  void HasNoEffect(const std::string& name, std::string when, std::function<bool()> is_so);

  std::vector<Option>::iterator begin() { return options_.begin(); }
  std::vector<Option>::iterator end() { return options_.end(); }
  std::vector<Option>::const_iterator begin() const { return options_.begin(); }
  std::vector<Option>::const_iterator end() const { return options_.end(); }
  /// The option with this name or former name; null if there is none.
  Option* Find(const std::string& name);
  std::vector<std::string> Names() const;

  /// Sets an option, under the name that was given: its own or its former one.
  /// @throws UsageError: "--sex=mael: expected male or female; nearest: male".
  void Set(Option& option, const std::string& given_name, const Found& found, Channel channel);

  /// To be called when all options are set. ROS parameters may set what has no effect, since a
  /// launch file sets all of its own.
  /// @throws UsageError: "--trail_secs=3: has no effect without --trail".
  void CheckEffects() const;
  /// Whether the option of that name does anything as the others are now.
  [[nodiscard]] bool HasEffect(const std::string& name) const;

  /// One sentence for each former name of an option or a word that was given.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Condition {
    std::string name, when;
    std::function<bool()> is_so;
  };

  void OnSet(Option& option, const std::string& given_name, Channel channel,
             const std::string& origin);
  void Warn(std::string warning);

  std::vector<Option> options_;
  std::vector<Condition> conditions_;
  std::string group_;
  std::vector<std::string> warnings_;
};

/// Where values of options may come from.
using Lookup = std::function<std::optional<Found>(const std::string& name)>;

/// Sets the options that no later channel has set, by their names or former names.
/// @throws UsageError.
void SetFrom(const Lookup& lookup, Channel channel, OptionList& options);

}  // namespace kinescope::options
