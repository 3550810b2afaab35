#include "server/app/loads/report_pdf.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/scratch_folder.h"
#include "core/system/stop_signal.h"
#include "server/picture/child_process.h"

namespace kinescope::app {
namespace {

constexpr const char* kConverter = "weasyprint";
constexpr std::chrono::minutes kConverterLimit{5};  // some seconds per page are usual

// The preloaded library stays to the very end: Python unloads Pango when it ends, and a thread of
// Pango's that has yet to begin would crash the converter after its work is done. One that is not
// found is a warning of the loader's.
std::string Preloading(const char* library) {
  const char* const given = std::getenv("LD_PRELOAD");
  return fmt::format("LD_PRELOAD={}{}{}", library, given == nullptr ? "" : ":",
                     given == nullptr ? "" : given);
}

}  // namespace

std::string FindPdfConverter(std::string_view search_path, const std::string& given) {
  while (!search_path.empty()) {
    const std::size_t end = std::min(search_path.find(':'), search_path.size());
    const std::filesystem::path folder(search_path.substr(0, end));
    search_path.remove_prefix(std::min(end + 1, search_path.size()));
    const std::filesystem::path program = folder / kConverter;
    std::error_code ignored;
    if (!folder.empty() && std::filesystem::is_regular_file(program, ignored) &&
        ::access(program.c_str(), X_OK) == 0) {
      return program.string();
    }
  }
  throw UsageError(fmt::format(
      "--report={}: PDF needs the program {}, which is not installed; install it (apt install "
      "weasyprint), or write a report that ends in .html and print it from a browser",
      given, kConverter));
}

std::string FindPdfConverter(const std::string& given) {
  const char* const path = std::getenv("PATH");
  return FindPdfConverter(std::string_view(path == nullptr ? "" : path), given);
}

std::string HtmlToPdf(const std::string& converter, std::string_view html) {
  const ScratchFolder folder;
  const std::filesystem::path page = folder / "report.html", pdf = folder / "report.pdf";
  std::ofstream to(page, std::ios::binary);
  to.write(html.data(), static_cast<std::streamsize>(html.size()));
  to.close();
  if (!to) throw std::runtime_error(page.string() + ": cannot be written; is the disk full?");
  // Fonts in the PDF have a time of modification, which would be now.
  const ChildResult result =
      RunChild({"/usr/bin/env", "SOURCE_DATE_EPOCH=0", Preloading("libpangoft2-1.0.so.0"),
                converter, "--quiet", page.string(), pdf.string()},
               kConverterLimit);
  std::ifstream from(pdf, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(from), {});
  if (StopRequested()) throw std::runtime_error("interrupted; the report was not written");
  if (result.was_too_slow) {
    throw std::runtime_error(
        fmt::format("{}: no PDF after {} minutes", converter, kConverterLimit.count()));
  }
  if (result.exit_code != 0 || result.signal != 0 || bytes.rfind("%PDF", 0) != 0) {
    const std::string why = LastLineOf(result.err);
    throw std::runtime_error(fmt::format("{}: cannot convert the report: {}", converter,
                                         why.empty() ? "no message" : why));
  }
  return bytes;
}

}  // namespace kinescope::app
