#include "server/app/golden/golden_junit.h"

#include <fmt/format.h>

#include "core/system/utf8.h"
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

std::string CaseToXml(const CaseVerdict& verdict, const std::string& suite,
                      const std::filesystem::path& out) {
  std::string xml =
      fmt::format("    <testcase classname=\"golden {}\" name=\"{}\" file=\"{}\" time=\"{:.3f}\"",
                  suite, Xml(verdict.name), Xml(verdict.file.string()), verdict.secs);
  if (verdict.outcome == Outcome::kSame) return xml + "/>\n";
  const char* const kind = verdict.outcome == Outcome::kDiffers ? "failure" : "error";
  xml += fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n", kind,
                     Name(verdict.outcome), Xml(verdict.problems.front()), Lines(verdict.problems));
  std::string attached;
  for (const char* picture : {".actual.png", ".diff.png"}) {
    const std::filesystem::path path = out / (verdict.name + picture);
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
      attached += fmt::format("[[ATTACHMENT|{}]]\n", Xml(path.string()));
    }
  }
  if (!attached.empty()) xml += fmt::format("      <system-out>{}</system-out>\n", attached);
  return xml + "    </testcase>\n";
}

}  // namespace

std::string ToJunit(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& folder,
                    const std::filesystem::path& out) {
  const std::string suite = Xml(folder.string());
  OutcomeCounts counts;
  double secs = 0;
  std::string cases;
  for (const CaseVerdict& verdict : verdicts) {
    counts.Add(verdict.outcome);
    secs += verdict.secs;
    cases += CaseToXml(verdict, suite, out);
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
