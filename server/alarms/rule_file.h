/// The YAML file of rules (docs/alarms.md). Pure functions; any thread.
#pragma once

#include <string>

#include "server/alarms/rule.h"

namespace kinescope::alarms {

/// The rules of a server that was given none, as their file would be.
extern const char* const kDefaultRules;

/// `path`: a file, or "default". @throws UsageError "--alarms=PATH: line N: ..." with what is wrong
/// and what is expected.
Rules LoadRules(const std::string& path);

/// `text`: the content of `path`, which is not opened. @throws UsageError as above.
Rules ParseRules(const std::string& path, const std::string& text);

}  // namespace kinescope::alarms
