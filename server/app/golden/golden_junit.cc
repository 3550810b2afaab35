#include "server/app/golden/golden_junit.h"

#include <fmt/format.h>

#include <cstdlib>

#include "core/system/utf8.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_report_text.h"
#include "server/app/html.h"

namespace kinescope::app {
namespace {

// For contents and attributes. XML has no control characters, not even escaped.
std::string Xml(const std::string& text) { return EscapeHtml(PrintableLine(text)); }

std::string Lines(const std::vector<std::string>& problems) {
  std::string text;
  for (const std::string& problem : problems) text += Xml(problem) + "\n";
  return text;
}

// GitLab shows one picture, by its path from the project; Jenkins wants a path from the root.
std::string PathForServer(const std::filesystem::path& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  if (std::getenv("GITLAB_CI") == nullptr) return absolute.string();
  const char* const project = std::getenv("CI_PROJECT_DIR");
  return absolute
      .lexically_proximate(project != nullptr ? project : std::filesystem::current_path())
      .string();
}

std::string CaseToXml(const CaseVerdict& verdict, const std::string& suite,
                      const std::filesystem::path& out) {
  std::string xml =
      fmt::format("    <testcase classname=\"golden {}\" name=\"{}\" file=\"{}\" time=\"{:.3f}\"",
                  suite, Xml(verdict.name), Xml(verdict.file.string()), verdict.secs);
  const std::vector<std::string> lines = Explain(verdict);
  if (verdict.outcome == Outcome::kSame && lines.empty()) return xml + "/>\n";
  if (verdict.outcome == Outcome::kSame) {
    return xml +
           fmt::format(">\n      <system-out>{}</system-out>\n    </testcase>\n", Lines(lines));
  }
  const char* const kind = verdict.outcome == Outcome::kDiffers ? "failure" : "error";
  xml += fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n", kind,
                     Name(verdict.outcome), Xml(lines.empty() ? "" : lines.front()), Lines(lines));
  for (const auto& picture : {CompositeOf(out, verdict.name), NewPictureOf(out, verdict.name)}) {
    std::error_code ignored;
    if (!std::filesystem::exists(picture, ignored)) continue;
    xml += fmt::format("      <system-out>[[ATTACHMENT|{}]]\n</system-out>\n",
                       Xml(PathForServer(picture)));
    break;
  }
  return xml + "    </testcase>\n";
}

}  // namespace

std::string ToJunit(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& folder,
                    const std::filesystem::path& out) {
  const std::string suite = Xml(folder.string());
  OutcomeCounts counts;
  double secs = 0;
  std::string cases;
  for (const CaseVerdict* verdict : InOrder(verdicts)) {
    counts.Add(verdict->outcome);
    secs += verdict->secs;
    cases += CaseToXml(*verdict, suite, out);
  }
  const std::string numbers =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", verdicts.size(),
                  counts.different, counts.not_compared, secs);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n"
      "  <testsuite name=\"golden {1}\" {0}>\n{2}  </testsuite>\n</testsuites>\n",
      numbers, suite, cases);
}

}  // namespace kinescope::app
