#include "server/app/loads/report_pdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/system/errors.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TempFolder;

// A program of that name, which does what `script` says.
std::string MakeConverter(const TempFolder& folder, const std::string& script) {
  const std::filesystem::path program = folder / "weasyprint";
  std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  return program.string();
}

std::string PdfError(const std::string& converter) {
  try {
    static_cast<void>(HtmlToPdf(converter, "<p>page</p>"));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ReportPdf, NamesThePackageAndTheWayOutIfTheConverterIsMissing) {
  const TempFolder folder;
  std::ofstream(folder / "weasyprint") << "a file that is no program";
  try {
    FindPdfConverter("/nowhere::" + (folder / "").string(), "page.pdf");
    FAIL() << "found";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("--report=page.pdf"), HasSubstr("apt install weasyprint"),
                      HasSubstr("ends in .html and print it from a browser")));
  }
}

TEST(ReportPdf, FindsTheConverterInTheSearchPath) {
  const TempFolder folder;
  const std::string program = MakeConverter(folder, "exit 0");
  EXPECT_EQ(FindPdfConverter("/nowhere:" + std::filesystem::path(program).parent_path().string(),
                             "page.pdf"),
            program);
}

TEST(ReportPdf, ReturnsWhatTheConverterWrites) {
  const TempFolder folder;
  // --quiet IN OUT
  const std::string program = MakeConverter(
      folder, "printf '%%PDF-' > \"$3\"; cat \"$2\" >> \"$3\"; echo $SOURCE_DATE_EPOCH >> \"$3\"");
  EXPECT_EQ(HtmlToPdf(program, "<p>page</p>"), "%PDF-<p>page</p>0\n") << "the time is fixed";
}

TEST(ReportPdf, ReportsTheLastLineOfAConverterThatFails) {
  const TempFolder folder;
  EXPECT_THAT(
      PdfError(MakeConverter(folder, "echo Traceback >&2; echo 'no such font' >&2; exit 1")),
      AllOf(HasSubstr("weasyprint: cannot convert the report: no such font")));
}

TEST(ReportPdf, RejectsAFileThatIsNoPdf) {
  const TempFolder folder;
  EXPECT_THAT(PdfError(MakeConverter(folder, "echo text > \"$3\"")),
              HasSubstr("cannot convert the report"));
  EXPECT_THAT(PdfError(MakeConverter(folder, "exit 0")), HasSubstr("cannot convert the report"));
}

}  // namespace
}  // namespace kinescope::app
