#include "server/app/loads/load_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/system/errors.h"
#include "render/image/new_file.h"
#include "server/app/loads/report_pdf.h"
#include "server/app/loads/report_pictures.h"
#include "server/app/shell_word.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

bool IsPdf(const fs::path& path) { return path.extension() == ".pdf"; }

// Without the folders of its files, which are of one machine.
std::string PortableText(const options::Value& value) {
  std::string text = value.ToText();
  for (const fs::path& file : value.Files()) {
    const std::string path = file.string(), name = file.filename().string();
    const std::size_t at = text.find(path);
    if (at != std::string::npos) text.replace(at, path.size(), name);
  }
  return text;
}

std::string SourceName(const std::string& source) {
  return IsSubjectUrl(source) ? source : fs::path(source).filename().string();
}

}  // namespace

void CheckReportName(const std::string& path) {
  const std::string ending = fs::path(path).extension().string();
  if (ending == ".pdf") {
    FindPdfConverter(path);
  } else if (ending != ".html" && ending != ".htm") {
    throw UsageError(
        fmt::format("--report={}: expected a name that ends in .html, .htm or .pdf", path));
  }
}

ReportOrigin OriginOf(const std::string& source, const SourceIdentity& identity,
                      const options::OptionList& options) {
  ReportOrigin origin;
  if (KindOfSource(source) == SourceKind::kPose) {
    origin.digest = "written pose, no file";
  } else if (IsSubjectUrl(source)) {
    origin.digest = "generated motion, no file";
  } else if (identity.digest) {
    origin.digest =
        fmt::format("sha256 {}, {} bytes", identity.digest->sha256, identity.digest->bytes);
  } else {
    origin.digest = "not a file, no hash";
  }
  // Those that do not change the page.
  constexpr std::string_view kOthers[] = {
      "source",  "csv",   "json",   "layout",  "joints",
      "columns", "plots", "report", "backend", "draw_limit_secs"};
  origin.command = "kinescope loads " + ShellWord(SourceName(source));
  for (const options::Option& option : options) {
    const bool is_other =
        std::find(std::begin(kOthers), std::end(kOthers), option.name) != std::end(kOthers);
    if (is_other || option.channel == options::Channel::kDefault) continue;
    origin.command += fmt::format(" --{} {}", option.name, ShellWord(PortableText(*option.value)));
  }
  origin.command += " --report page.html";
  return origin;
}

void WriteReport(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                 const ReportOrigin& origin, const SensitivityRows& sensitivity,
                 const BackendOptions& backend, const fs::path& path) {
  render::NewFile file(path);  // first: a folder that takes no file is known before the work
  const auto renderer = StartRenderer(backend);
  std::string pages;
  std::size_t number = 0;
  for (const auto& [character, trial] : trials) {
    pages += PageHtml({trial, context, origin, DrawWorstPostures(trial, *renderer),
                       sensitivity(character), ++number, trials.size()});
  }
  std::string content = ReportDocument(context, pages);
  if (IsPdf(path)) content = HtmlToPdf(FindPdfConverter(path.string()), content);
  file.Write(content.data(), content.size());
  file.Commit();
}

}  // namespace kinescope::app
