/// Sources by URL, the same everywhere: `udp://:9763`, `udp://0.0.0.0:9763`, `motion.mvnx`,
/// `demo:lift`, `demo:walk`.
#pragma once

#include <memory>
#include <string>

#include "server/core/source.h"

namespace kinescope::mvn {

/// @throws SourceError naming the URL, what is wrong and what would be right (port taken, file
/// missing, not MVNX, unknown scheme).
std::unique_ptr<Source> OpenUdp(const std::string& url);
std::unique_ptr<Source> OpenMvnx(const std::string& path);

}  // namespace kinescope::mvn
