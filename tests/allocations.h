/// How often the process has called operator new, and memory that runs out when a test wants it to.
/// For a program of its own that is not sanitized: linking allocations.cc replaces the operators of
/// the whole process. Any thread.
#pragma once

#include <cstddef>

namespace kinescope::testing {

std::size_t Allocations();

/// The next operator new of at least `bytes` on any thread but the caller's throws std::bad_alloc,
/// once.
void FailNextAllocationElsewhere(std::size_t bytes);

}  // namespace kinescope::testing
