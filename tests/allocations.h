/// How often the process has called operator new. For a program of its own that is not sanitized:
/// linking allocations.cc replaces the operators of the whole process.
#pragma once

#include <cstddef>

namespace kinescope::testing {

std::size_t Allocations();

}  // namespace kinescope::testing
