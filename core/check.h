/// KINESCOPE_CHECK: stops the process when we broke a promise of our own. On in every build. Never
/// for anything that input, a user or the machine can cause.
#pragma once

namespace kinescope {

/// Prints the place and the condition to stderr and aborts.
[[noreturn]] void CheckFailed(const char* file, int line, const char* condition);

}  // namespace kinescope

#define KINESCOPE_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::kinescope::CheckFailed(__FILE__, __LINE__, #condition))
