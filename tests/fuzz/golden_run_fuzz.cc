// Any text as golden.lock and as run.json of a check, which comes from a CI server: a reason, or
// values that are written as they were read.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "core/system/check.h"
#include "server/app/golden/finding.h"
#include "server/app/golden/golden_changes.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/golden_run.h"

namespace {

void TryAccepted(const kinescope::app::AcceptedCase& accepted) {
  using namespace kinescope::app;
  const std::string text = ToJson(accepted);
  const AcceptedCase again = AcceptedFrom(nlohmann::json::parse(text));
  KINESCOPE_CHECK(ToJson(again) == text);
  Summarize(Compare(accepted.facts, PictureFacts()));
  KINESCOPE_CHECK(CauseOf(ChangesBetween(again, again)) == "program");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    for (const auto& [name, accepted] : app::ParseLock(text)) TryAccepted(accepted);
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  try {
    for (const app::CaseOfRun& each : app::ParseRun(text).cases) {
      if (each.now) TryAccepted(*each.now);
    }
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}
