// Lists of jobs and results of a batch: lines of JSON from files that anybody may have written.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/app/batch/job.h"
#include "server/app/batch/job_result.h"

namespace jobs_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope::app;
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  try {
    const std::string written = ToLine(ReadJob(line));
    // What is written is one line, and reads as itself.
    KINESCOPE_CHECK(written.find('\n') == std::string::npos);
    KINESCOPE_CHECK(ToLine(ReadJob(written)) == written);
  } catch (const kinescope::UsageError&) {
  }
  try {
    const std::string written = ToLine(ReadResult(line));
    KINESCOPE_CHECK(written.find('\n') == std::string::npos);
    ReadResult(written);
  } catch (const std::exception&) {
  }
  return 0;
}

}  // namespace jobs_fuzz
