/// Converts the report to PDF with WeasyPrint, a program that is only needed for that. It runs as a
/// child process. Equal HTML gives equal bytes. Any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope::app {

/// The path of the program in `search_path` (as PATH has it).
/// @throws UsageError that names the package and the alternative, for the option value `given`.
std::string FindPdfConverter(std::string_view search_path, const std::string& given);
/// In this process' PATH.
std::string FindPdfConverter(const std::string& given);

/// `html` as PDF. @throws std::runtime_error with the reason.
std::string HtmlToPdf(const std::string& converter, std::string_view html);

}  // namespace kinescope::app
