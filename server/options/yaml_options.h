/// Options in a YAML file of `name: value` lines.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/options/option_list.h"

namespace kinescope::options {

class YamlOptions {
 public:
  /// @throws UsageError naming the file, the line and the reason.
  explicit YamlOptions(const std::string& path);
  /// `text`: the content of `path`, which is not opened. @throws UsageError as above.
  YamlOptions(const std::string& path, const std::string& text);
  ~YamlOptions();

  /// The text of `name`, and "FILE:LINE: ". @throws UsageError where it is not one value.
  std::optional<Found> Look(const std::string& name) const;

  /// The same for an option that may be given several times: a list has its texts.
  std::optional<Found> LookForList(const std::string& name) const;

  /// Sets `options` that were not given before, and refuses a name that none of them has.
  /// @param help  what lists all names, for the error
  /// @throws UsageError naming file, line, name and the nearest one.
  void SetAll(OptionList& options, const char* help = "--help") const;

 private:
  struct Root;  // keeps yaml-cpp out of here
  template <class Read>
  void Load(const Read& read);

  std::string path_;
  std::unique_ptr<Root> root_;
};

}  // namespace kinescope::options
