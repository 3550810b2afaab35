/// Where a server keeps what people make with it. Any thread.
#pragma once

#include <filesystem>

namespace kinescope {

/// That of the service (STATE_DIRECTORY) or of the user (XDG_STATE_HOME, ~/.local/state); the
/// working folder without one. It may not be there yet.
std::filesystem::path StateFolder();

}  // namespace kinescope
