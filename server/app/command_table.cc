#include "server/app/command_table.h"

#include <stdexcept>

namespace kinescope::app {

const CommandEntry* FindCommand(const std::string& name) {
  for (const CommandEntry& entry : kCommands) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

std::vector<std::string> CommandNames() {
  std::vector<std::string> names;
  for (const CommandEntry& entry : kCommands) names.emplace_back(entry.name);
  return names;
}

std::filesystem::path ProgramOf(const std::string& command) {
  const CommandEntry* const entry = FindCommand(command);
  const std::string name = entry == nullptr ? kMainProgram : entry->program;
  std::filesystem::path program = FindProgram(name);
  if (!program.empty()) return program;
  const std::filesystem::path build = FindBuildFolder();
  throw std::runtime_error(
      "libexec/kinescope/" + name + (entry == nullptr ? "" : ", which has " + command + ",") +
      (build.empty() ? " was not found beside bin; install Kinescope completely"
                     : " is not built yet; build it with: cmake --build " + build.string()));
}

}  // namespace kinescope::app
