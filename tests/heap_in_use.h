/// Bytes that the program has allocated and not freed, for tests of "constant memory". 0 under the
/// sanitizers, whose heap is another.
#pragma once

#include <malloc.h>

#include <cstddef>

namespace kinescope::testing {

inline std::size_t HeapInUse() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace kinescope::testing
