/// What decides a picture besides the program, then and now, and what follows from it for the
/// verdict. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/golden/golden_lock.h"

namespace kinescope::app {

/// One line each: "time: was 2, is 2.5".
struct GoldenChanges {
  std::vector<std::string> options;
  std::vector<std::string> inputs;
  std::vector<std::string> environment;
  /// Of a web page that is not ours: this program draws nothing of it.
  bool is_page = false;
};

/// Whether the case draws a web page that is not our dashboard.
bool IsForeignPage(const AcceptedCase& of_case);

GoldenChanges ChangesBetween(const AcceptedCase& accepted, const AcceptedCase& now);

/// What a difference says: "recording", "case", "environment", "page" or "program".
std::string CauseOf(const GoldenChanges& changes);

/// The same as a sentence, with what has changed.
std::string CauseText(const GoldenChanges& changes);

}  // namespace kinescope::app
