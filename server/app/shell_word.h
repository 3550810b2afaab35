/// Quotes words of commands that people copy. Pure functions; any thread.
#pragma once

#include <string>

namespace kinescope::app {

/// `text` as one word of a shell. Names come from files of anyone.
std::string ShellWord(const std::string& text);

}  // namespace kinescope::app
