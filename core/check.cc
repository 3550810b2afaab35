#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace kinescope {

void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "%s:%d: a promise of Kinescope itself is broken: %s\n", file, line,
               condition);
  std::abort();
}

}  // namespace kinescope
