#include "server/app/print.h"

#include <cerrno>
#include <string>

#include "core/system/standard_streams.h"
#include "core/system/utf8.h"

namespace kinescope::app {

void PrintText(std::FILE* stream, std::string_view text) {
  const std::string printable = PrintableLines(text);
  const bool is_written =
      std::fwrite(printable.data(), 1, printable.size(), stream) == printable.size();
  if (is_written || stream != stdout) return;
  FailOfStandardOutput(errno);
}

}  // namespace kinescope::app
