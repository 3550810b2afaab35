#include "core/system/check.h"

#include <cstdio>
#include <cstdlib>

namespace kinescope {

void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "%s:%d: internal error, condition failed: %s\n", file, line, condition);
  std::abort();
}

}  // namespace kinescope
