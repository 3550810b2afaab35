/// The log of the program: one line per message on standard error.
#pragma once

#include <spdlog/logger.h>

#include <memory>

namespace kinescope::app {

/// Names in messages are untrusted: control characters and line breaks become U+FFFD.
void MakeLinesPrintable(spdlog::logger& log);

}  // namespace kinescope::app
