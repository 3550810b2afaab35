/// Counts calls of operator new in the process, and lets memory run out on request. Only for a
/// separate test program without sanitizers: linking allocations.cc replaces the operators of the
/// whole process. Any thread.
#pragma once

#include <cstddef>

namespace kinescope::testing {

std::size_t Allocations();

/// The next operator new of at least `bytes` on any thread but the caller's throws std::bad_alloc,
/// once.
void FailNextAllocationElsewhere(std::size_t bytes);

}  // namespace kinescope::testing
