/// KINESCOPE_CHECK stops the process on an internal error. It is active in every build. Never use
/// it for conditions that input, a user or the machine can cause.
#pragma once

namespace kinescope {

/// Prints file, line and condition to stderr and aborts.
[[noreturn]] void CheckFailed(const char* file, int line, const char* condition);

}  // namespace kinescope

#define KINESCOPE_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::kinescope::CheckFailed(__FILE__, __LINE__, #condition))
