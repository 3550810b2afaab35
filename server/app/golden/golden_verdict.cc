#include "server/app/golden/golden_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/system/words.h"

namespace kinescope::app {

const char* Name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: return "same";
    case Outcome::kDiffers: return "differs";
    case Outcome::kNotCompared: break;
  }
  return "not compared";
}

const char* LoudName(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: return "same";
    case Outcome::kDiffers: return "DIFFERS";
    case Outcome::kNotCompared: break;
  }
  return "NOT COMPARED";
}

std::string FaultOf(const CaseVerdict& verdict) {
  for (const GoldenFinding& finding : verdict.findings) {
    if (finding.kind == FindingKind::kFault) return finding.text;
  }
  return "";
}

bool IsWeaker(const CaseVerdict& verdict) {
  return verdict.outcome == Outcome::kSame && !verdict.changes.environment.empty();
}

bool HasCause(const CaseVerdict& verdict) {
  return verdict.now && !verdict.accepted_pixels.empty() &&
         std::any_of(
             verdict.findings.begin(), verdict.findings.end(),
             [](const GoldenFinding& finding) { return finding.kind != FindingKind::kPicture; });
}

std::vector<std::string> Explain(const CaseVerdict& verdict) {
  std::vector<std::string> lines;
  if (!verdict.reason.empty()) lines.push_back(verdict.reason);
  for (std::string& line : Summarize(verdict.findings)) lines.push_back(std::move(line));
  if (HasCause(verdict)) lines.push_back(CauseText(verdict.changes));
  for (const std::string& note : verdict.notes) lines.push_back(note);
  return lines;
}

void OutcomeCounts::Add(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: ++same; break;
    case Outcome::kDiffers: ++different; break;
    case Outcome::kNotCompared: ++not_compared; break;
  }
}

int OutcomeCounts::ExitCode() const {
  if (not_compared > 0) return 2;
  return different > 0 ? 1 : 0;
}

OutcomeCounts CountsOf(const std::vector<CaseVerdict>& verdicts) {
  OutcomeCounts counts;
  for (const CaseVerdict& verdict : verdicts) counts.Add(verdict.outcome);
  return counts;
}

std::string Headline(const OutcomeCounts& counts) {
  if (counts.all() == 0) return "There is no picture to compare";
  const std::string all = Counted(counts.all(), "picture");
  if (counts.ExitCode() == 0) {
    return counts.all() == 1 ? "The picture is the same" : fmt::format("All {} are the same", all);
  }
  std::string text;
  if (counts.different > 0) {
    text = fmt::format("{} of {} {}", counts.different, all,
                       counts.different == 1 ? "differs" : "differ");
  }
  if (counts.not_compared == 0) return text;
  if (!text.empty()) return text + fmt::format(", {} could not be compared", counts.not_compared);
  return fmt::format("{} of {} could not be compared", counts.not_compared, all);
}

}  // namespace kinescope::app
