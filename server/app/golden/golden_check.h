/// `golden check`: draws every case and says whether its picture has changed, and what in it. A
/// case that cannot be compared has a verdict of its own and keeps no other case from being
/// compared.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/app/golden/golden_suite.h"

namespace kinescope::app {

enum class Outcome {
  kSame,
  kDiffers,
  kNotCompared,  // nothing is known of the picture: not readable, not accepted yet
};

/// "same", "differs", "not compared".
const char* Name(Outcome outcome);

struct CaseVerdict {
  std::string name;  // of the case, or of a file that belongs to none
  std::string why;   // purpose of the case
  std::filesystem::path file;
  Outcome outcome = Outcome::kSame;
  std::vector<std::string> problems;  // the most telling first; empty if kSame
  double secs = 0;
};

struct CheckSettings {
  std::filesystem::path out;  // folder for the pictures of cases that differ
};

/// Calls `report` with every verdict, in the order of the suite, orphans last.
/// @throws std::runtime_error if a picture cannot be written, or when interrupted.
void CheckSuite(const GoldenSuite& suite, const CheckSettings& settings, render::Renderer& renderer,
                const std::function<void(const CaseVerdict&)>& report);

/// How many verdicts there are of each outcome.
struct OutcomeCounts {
  std::size_t same = 0, different = 0, not_compared = 0;

  void Add(Outcome outcome);
  /// 0: all are the same. 2 if a case was not compared, whatever the others are: the verdict is
  /// not known then. Else 1.
  int ExitCode() const;
};

}  // namespace kinescope::app
