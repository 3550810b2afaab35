#include "server/app/golden/golden_report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "server/app/html.h"

namespace kinescope::app {

std::string WithDots(const std::string& text) {
  std::string html;
  std::size_t from = 0;
  for (std::size_t open = text.find('('); open != std::string::npos; open = text.find('(', from)) {
    const std::size_t close = text.find(')', open);
    if (close == std::string::npos) break;
    const std::string inside = text.substr(open + 1, close - open - 1);
    const std::string before = text.substr(from, open - from);
    const std::size_t word = before.size() < 2 ? 0 : before.rfind(' ', before.size() - 2) + 1;
    html += EscapeHtml(before.substr(0, word));
    for (const char* color : {"green", "orange", "red", "grey"}) {
      if (inside == color) html += fmt::format("<i class=\"dot {}\"></i>", color);
    }
    html += EscapeHtml(before.substr(word) + text.substr(open, close + 1 - open));
    from = close + 1;
  }
  return html + EscapeHtml(text.substr(from));
}

std::string FirstLine(const CaseVerdict& verdict) {
  if (!verdict.reason.empty()) return verdict.reason;
  const std::vector<std::string> lines = Summarize(verdict.findings);
  return lines.empty() ? "" : lines.front().substr(0, lines.front().find("; "));
}

std::vector<const CaseVerdict*> InOrder(const std::vector<CaseVerdict>& verdicts) {
  const auto rank = [](const CaseVerdict& verdict) {
    if (verdict.outcome == Outcome::kSame) return 200;
    if (verdict.outcome == Outcome::kNotCompared) return 101;
    if (!verdict.now) return 100;  // a file of no case
    return verdict.findings.empty() ? 99 : static_cast<int>(verdict.findings.front().kind);
  };
  std::vector<const CaseVerdict*> all;
  all.reserve(verdicts.size());
  for (const CaseVerdict& verdict : verdicts) all.push_back(&verdict);
  std::stable_sort(all.begin(), all.end(),
                   [&](const CaseVerdict* a, const CaseVerdict* b) { return rank(*a) < rank(*b); });
  return all;
}

std::vector<GoldenFinding> WithoutLayers(const std::vector<GoldenFinding>& findings) {
  std::vector<GoldenFinding> others;
  for (const GoldenFinding& finding : findings) {
    if (finding.kind < FindingKind::kLight) others.push_back(finding);
  }
  return others;
}

}  // namespace kinescope::app
