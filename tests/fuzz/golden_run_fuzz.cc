// Any text as golden.lock, and as run.json and review.json of a check, which come from a CI server:
// a reason, or values that are written as they were read, and shown on a page as text alone.
// Also as masks and tolerances of a case.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "core/system/check.h"
#include "server/app/golden/finding.h"
#include "server/app/golden/golden_changes.h"
#include "server/app/golden/golden_decisions.h"
#include "server/app/golden/golden_limits.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/golden_report.h"
#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_verdict_json.h"

namespace golden_run_fuzz {
namespace {

using namespace kinescope::app;

void TryAccepted(const AcceptedCase& accepted) {
  const std::string text = ToJson(accepted);
  const AcceptedCase again = AcceptedFrom(nlohmann::json::parse(text));
  KINESCOPE_CHECK(ToJson(again) == text);
  Summarize(Compare(accepted.facts, PictureFacts()));
  KINESCOPE_CHECK(CauseOf(ChangesBetween(again, again)) == "program");
}

void TryLimits(const std::string& text) {
  MasksValue masks;
  LimitsValue limits;
  try {
    masks.Parse(text);
    const std::string again = masks.ToText();
    masks.Parse(again);
    KINESCOPE_CHECK(masks.ToText() == again);
    CheckMasks(*masks, 640, 360);
    IsMasked(*masks, 1, 1);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  try {
    limits.Parse(text);
    KINESCOPE_CHECK(limits->picture.light <= 10 && limits->place_px <= 20);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
}

std::size_t CountOf(const std::string& wanted, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos;
       at = text.find(wanted, at + 1)) {
    ++count;
  }
  return count;
}

void TryRun(const std::string& text) {
  const GoldenRun run = ParseRun(text);
  for (const CaseVerdict& each : run.verdicts) {
    Explain(each);
    const std::string whole = ToWholeJson(each, "").dump();
    KINESCOPE_CHECK(ToWholeJson(VerdictFrom(nlohmann::json::parse(whole)), "").dump() == whole);
    if (!each.now) continue;
    TryAccepted(*each.now);
    KINESCOPE_CHECK(each.name.find('/') == std::string::npos);
  }
  ReportSettings settings{"/proc/nowhere", "/proc/nowhere", "/proc/nowhere"};
  settings.version = run.version;
  settings.review = ReviewedPage{"token", "nonce"};
  const std::string page = GoldenReport(run.verdicts, settings);
  KINESCOPE_CHECK(CountOf("<script", page) <= 1 && CountOf("<style", page) == 1);
  KINESCOPE_CHECK(CountOf("<img", page) == 0 && CountOf("<iframe", page) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  TryLimits(text);
  try {
    for (const auto& [name, accepted] : ParseLock(text)) TryAccepted(accepted);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  try {
    TryRun(text);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  try {
    for (const auto& [name, each] : ParseDecisions(text)) {
      KINESCOPE_CHECK(each.decision == Decision::kRejected || each.decision == Decision::kLater);
    }
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}

}  // namespace golden_run_fuzz
