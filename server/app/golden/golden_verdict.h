/// What a check says of a case, as data: terminal, JSON, JUnit, report and summary print it. Pure
/// functions; any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/image/tile.h"
#include "server/app/golden/finding.h"
#include "server/app/golden/golden_changes.h"
#include "server/app/golden/golden_frame.h"
#include "server/app/golden/golden_lock.h"

namespace kinescope::app {

enum class Outcome {
  kSame,
  kDiffers,
  kNotCompared,  // nothing is known of the picture: not readable, not accepted yet
};

/// "same", "differs", "not compared".
const char* Name(Outcome outcome);
/// As a heading in a terminal, where what fails is seen: "same", "DIFFERS", "NOT COMPARED".
const char* LoudName(Outcome outcome);

/// One of the ways of comparing, with its number.
struct GoldenLayer {
  std::string name;   // "objects", "structure", "light", "pixels"
  std::string found;  // with its limit
  bool passes = true;
  nlohmann::json numbers = nullptr;  // what was found, as docs/json.md describes it
};

struct CaseVerdict {
  std::string name;                  // of the picture, or of a file that belongs to no case
  std::optional<GoldenFrame> frame;  // of a clip
  std::string why;                   // purpose of the case
  std::filesystem::path file;
  int line = 1;  // of the file: the key that explains it best
  Outcome outcome = Outcome::kSame;
  std::vector<GoldenFinding> findings;  // kDiffers: the worst first
  std::string reason;                   // kNotCompared: why
  std::vector<std::string> notes;       // what makes the check weaker
  std::vector<render::Tile> masks;      // parts that are not compared, px
  std::vector<GoldenLayer> layers;      // empty where the pixels are equal
  bool is_byte_equal = false;
  GoldenChanges changes;
  std::string accepted_pixels;      // SHA-256; "": nothing is accepted
  std::optional<AcceptedCase> now;  // nullopt: it was not drawn
  double secs = 0;
};

/// Why the new picture must not be accepted, though it was drawn; "": it may be.
std::string FaultOf(const CaseVerdict& verdict);

/// Whether it is the same only in another environment than that of the accepted picture.
bool IsWeaker(const CaseVerdict& verdict);

/// Whether CauseOf() explains the difference: it is of what was drawn, not only of accepted files.
bool HasCause(const CaseVerdict& verdict);

/// The lines that explain it, the most telling first; empty if it is the same and nothing is weak.
std::vector<std::string> Explain(const CaseVerdict& verdict);

/// How many verdicts there are of each outcome.
struct OutcomeCounts {
  std::size_t same = 0, different = 0, not_compared = 0;

  void Add(Outcome outcome);
  std::size_t all() const { return same + different + not_compared; }
  /// 0: all are the same. 2 if a case was not compared, whatever the others are: the verdict is
  /// not known then. Else 1.
  int ExitCode() const;
};

OutcomeCounts CountsOf(const std::vector<CaseVerdict>& verdicts);

/// "7 of 14 pictures differ, 2 could not be compared".
std::string Headline(const OutcomeCounts& counts);

}  // namespace kinescope::app
