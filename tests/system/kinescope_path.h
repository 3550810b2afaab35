/// Which kinescope is under test.
#pragma once

#include <cstdlib>
#include <string>

#include "tests/folders.h"

namespace kinescope::testing {

/// That of this build, or the one that KINESCOPE_PROGRAM in the environment names, such as the
/// sanitized one.
inline std::string KinescopePath() {
  const char* const other = std::getenv("KINESCOPE_PROGRAM");
  return other == nullptr ? InBuild("bin/kinescope").string() : other;
}

}  // namespace kinescope::testing
