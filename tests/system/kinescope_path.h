/// Which kinescope is under test. For targets with the definition KINESCOPE_PROGRAM, the path of
/// that of this build.
#pragma once

#include <cstdlib>
#include <string>

namespace kinescope::testing {

/// That of this build, or the one that KINESCOPE_PROGRAM in the environment names, such as the
/// sanitized one.
inline std::string KinescopePath() {
  const char* const other = std::getenv("KINESCOPE_PROGRAM");
  return other == nullptr ? KINESCOPE_PROGRAM : other;
}

}  // namespace kinescope::testing
