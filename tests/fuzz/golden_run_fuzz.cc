// Any text as golden.lock and as run.json of a check, which comes from a CI server: a reason, or
// values that are written as they were read. Also as masks and tolerances of a case.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "core/system/check.h"
#include "server/app/golden/finding.h"
#include "server/app/golden/golden_changes.h"
#include "server/app/golden/golden_limits.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_verdict_json.h"

namespace {

void TryAccepted(const kinescope::app::AcceptedCase& accepted) {
  using namespace kinescope::app;
  const std::string text = ToJson(accepted);
  const AcceptedCase again = AcceptedFrom(nlohmann::json::parse(text));
  KINESCOPE_CHECK(ToJson(again) == text);
  Summarize(Compare(accepted.facts, PictureFacts()));
  KINESCOPE_CHECK(CauseOf(ChangesBetween(again, again)) == "program");
}

void TryLimits(const std::string& text) {
  using namespace kinescope::app;
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string text(reinterpret_cast<const char*>(data), size);
  TryLimits(text);
  try {
    for (const auto& [name, accepted] : app::ParseLock(text)) TryAccepted(accepted);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  try {
    for (const app::CaseVerdict& each : app::ParseRun(text).cases) {
      if (each.now) TryAccepted(*each.now);
      const std::string whole = ToWholeJson(each, "").dump();
      KINESCOPE_CHECK(ToWholeJson(app::VerdictFrom(nlohmann::json::parse(whole)), "").dump() ==
                      whole);
    }
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}
