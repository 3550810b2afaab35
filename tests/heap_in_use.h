/// Memory that the program has allocated, for tests of limited memory use.
#pragma once

#include <malloc.h>

#include <atomic>
#include <cstddef>

#include "tests/sanitized.h"

#ifdef KINESCOPE_SANITIZED
#include <sanitizer/allocator_interface.h>
#endif

namespace kinescope::testing {

/// Bytes that are allocated and not freed.
inline std::size_t HeapInUse() {
#ifdef KINESCOPE_SANITIZED
  return __sanitizer_get_current_allocated_bytes();
#else
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

/// Bytes of the largest allocation since the last call, of any thread; 0 without sanitizers.
inline std::size_t LargestAllocation() {
  static std::atomic<std::size_t> largest{0};
#ifdef KINESCOPE_SANITIZED
  static const int is_installed = __sanitizer_install_malloc_and_free_hooks(
      [](const volatile void*, std::size_t size) {
        if (size > largest) largest = size;
      },
      [](const volatile void*) {});
  static_cast<void>(is_installed);
#endif
  return largest.exchange(0);
}

}  // namespace kinescope::testing
