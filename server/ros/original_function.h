/// The functions of a shared library that Kinescope defines again (xmlrpc_limits.h,
/// tcpros_limits.h).
#pragma once

#include <dlfcn.h>

#include "core/system/check.h"

namespace kinescope::ros_bridge {

/// The function of the library that the one of this name here takes precedence over. A member is
/// called through its address as a function whose first argument is the object, as the ABI has it.
template <class Function>
Function Original(const char* symbol) {
  void* const found = dlsym(RTLD_NEXT, symbol);
  KINESCOPE_CHECK(found != nullptr);
  return reinterpret_cast<Function>(found);
}

}  // namespace kinescope::ros_bridge
