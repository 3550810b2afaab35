/// Number of bytes that the program has allocated and not freed, for tests of constant memory use.
#pragma once

#include <malloc.h>

#include <cstddef>

#include "tests/sanitized.h"

#ifdef KINESCOPE_SANITIZED
#include <sanitizer/allocator_interface.h>
#endif

namespace kinescope::testing {

inline std::size_t HeapInUse() {
#ifdef KINESCOPE_SANITIZED
  return __sanitizer_get_current_allocated_bytes();
#else
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

}  // namespace kinescope::testing
