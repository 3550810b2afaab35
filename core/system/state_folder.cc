#include "core/system/state_folder.h"

#include <cstdlib>
#include <string>

namespace kinescope {

std::filesystem::path StateFolder() {
  const auto value = [](const char* name) {
    const char* const text = std::getenv(name);
    return std::string(text == nullptr ? "" : text);
  };
  const std::string service = value("STATE_DIRECTORY");  // several are separated by colons
  if (!service.empty()) return service.substr(0, service.find(':'));
  if (!value("XDG_STATE_HOME").empty()) {
    return std::filesystem::path(value("XDG_STATE_HOME")) / "kinescope";
  }
  if (!value("HOME").empty()) {
    return std::filesystem::path(value("HOME")) / ".local/state/kinescope";
  }
  return "";
}

}  // namespace kinescope
