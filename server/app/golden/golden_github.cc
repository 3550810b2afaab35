#include "server/app/golden/golden_github.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "core/system/utf8.h"
#include "server/app/golden/golden_report_text.h"
#include "server/app/html.h"
#include "server/app/shell_word.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostSummary = 900'000;  // bytes
constexpr std::size_t kMostAnnotations = 10, kMostAnnotationLines = 8;

std::vector<const CaseVerdict*> Failures(const std::vector<CaseVerdict>& verdicts) {
  std::vector<const CaseVerdict*> failures;
  for (const CaseVerdict* verdict : InOrder(verdicts)) {
    if (verdict->outcome != Outcome::kSame) failures.push_back(verdict);
  }
  return failures;
}

std::string Replaced(const std::string& text, char what, const char* by) {
  std::string replaced;
  for (const char c : text) {
    if (c == what) {
      replaced += by;
    } else {
      replaced += c;
    }
  }
  return replaced;
}

// Of a workflow command: GitHub decodes it. Line breaks of our own are added after.
std::string CommandText(const std::string& text) {
  return Replaced(PrintableLine(text), '%', "%25");
}

std::string CommandProperty(const std::string& text) {
  return Replaced(Replaced(CommandText(text), ':', "%3A"), ',', "%2C");
}

// GitHub looks for it in the checkout.
std::string FileInCheckout(const std::filesystem::path& file) {
  const char* const checkout = std::getenv("GITHUB_WORKSPACE");
  if (checkout == nullptr || *checkout == '\0') return file.string();
  const auto relative = std::filesystem::absolute(file).lexically_normal().lexically_relative(
      std::filesystem::path(checkout).lexically_normal());
  const bool is_inside = !relative.empty() && *relative.begin() != "..";
  return is_inside ? relative.string() : file.string();
}

std::string Annotation(const CaseVerdict& verdict, const std::filesystem::path& out) {
  std::vector<std::string> lines;
  for (const std::string& line : Explain(verdict)) {
    if (lines.size() == kMostAnnotationLines) break;
    lines.push_back(CommandText(line));
  }
  if (verdict.now) {
    lines.push_back(CommandText(fmt::format("Accept: kinescope golden accept {} {}",
                                            ShellWord(out.string()), ShellWord(verdict.name))));
  }
  return fmt::format(
      "::error file={},line={},title={}::{}\n", CommandProperty(FileInCheckout(verdict.file)),
      verdict.line,
      CommandProperty(fmt::format("golden {}: {}", verdict.name, Name(verdict.outcome))),
      fmt::join(lines, "%0A"));
}

// "3 pictures were compared in another environment (backend: was osmesa, is egl)"; "": none.
std::string Weakness(const std::vector<CaseVerdict>& verdicts) {
  const auto count = std::count_if(verdicts.begin(), verdicts.end(), IsWeaker);
  if (count == 0) return "";
  const auto first = std::find_if(verdicts.begin(), verdicts.end(), IsWeaker);
  return fmt::format(
      "weaker check: {} compared in another environment than that of the accepted "
      "{} ({})",
      count == 1 ? "1 picture was" : fmt::format("{} pictures were", count),
      count == 1 ? "one" : "ones", fmt::join(first->changes.environment, "; "));
}

}  // namespace

std::string ToMarkdown(const std::vector<CaseVerdict>& verdicts, const std::filesystem::path& out) {
  const OutcomeCounts counts = CountsOf(verdicts);
  std::string text =
      fmt::format("## {} {}\n\n", counts.ExitCode() == 0 ? "✓" : "✕", EscapeHtml(Headline(counts)));
  if (const std::string weakness = Weakness(verdicts); !weakness.empty()) {
    text += EscapeHtml(weakness) + "\n\n";
  }
  if (counts.ExitCode() == 0) return text;
  text += fmt::format(
      "{} passed, exit code {}. Pictures and commands: `{}/report.html` of this run (artifact).\n\n"
      "| case | in words | what changed |\n|---|---|---|\n",
      counts.same, counts.ExitCode(), EscapeHtml(out.string()));
  const auto failures = Failures(verdicts);
  std::size_t shown = 0;
  for (const CaseVerdict* verdict : failures) {
    const std::vector<std::string> lines = Explain(*verdict);
    std::string row =
        fmt::format("| **{}** | {} | {} |\n", EscapeHtml(verdict->name),
                    lines.empty() ? "" : EscapeHtml(lines.front()),
                    HasCause(*verdict) ? CauseOf(verdict->changes) : Name(verdict->outcome));
    if (text.size() + row.size() > kMostSummary / 2) break;
    text += row;
    ++shown;
  }
  if (shown < failures.size()) text += fmt::format("\nand {} more\n", failures.size() - shown);
  text += "\n<details><summary>All changes in words</summary>\n\n";
  for (const CaseVerdict* verdict : failures) {
    std::string part = fmt::format("**{}**\n", EscapeHtml(verdict->name));
    for (const std::string& line : Explain(*verdict)) part += "- " + EscapeHtml(line) + "\n";
    if (text.size() + part.size() > kMostSummary) break;
    text += part + "\n";
  }
  return text + "</details>\n";
}

std::string ToAnnotations(const std::vector<CaseVerdict>& verdicts,
                          const std::filesystem::path& out) {
  const auto failures = Failures(verdicts);
  std::string text;
  std::size_t room = kMostAnnotations;
  if (failures.size() > room) {
    --room;
    text += fmt::format(
        "::error title=golden::{}. The worst {} are shown here; {}/report.html shows all\n",
        CommandText(Headline(CountsOf(verdicts))), room, CommandText(out.string()));
  }
  for (std::size_t i = 0; i < failures.size() && i < room; ++i) {
    text += Annotation(*failures[i], out);
  }
  if (const std::string weakness = Weakness(verdicts); !weakness.empty()) {
    text += fmt::format("::warning title=golden::{}\n", CommandText(weakness));
  }
  return text;
}

}  // namespace kinescope::app
