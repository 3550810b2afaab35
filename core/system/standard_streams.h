/// The descriptors 0 to 2 (standard input, output and error) at the start and the end of a process.
#pragma once

namespace kinescope {

/// Opens /dev/null in place of those that the caller of the program closed (`<&- >&-`). Otherwise
/// the next socket or file would get the number of a standard stream, and everything printed would
/// be written into it. Call it first in main.
void OpenStandardStreams();

/// Ends the process like any other whose reader has gone (`| head`), without a word, if `error` is
/// EPIPE. @param error errno of a write to standard output, 0: unknown  @throws std::runtime_error
/// with the reason otherwise
[[noreturn]] void FailOfStandardOutput(int error);

/// Writes what is still buffered for standard output. @throws std::runtime_error if this or an
/// earlier write failed; the end of a process would not report it.
void FlushStandardOutput();

}  // namespace kinescope
