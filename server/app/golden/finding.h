/// What has changed in a picture, as data and in words. Pure functions; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/app/golden/picture_facts.h"

namespace kinescope::app {

/// The worst first: what would mislead a person who looks at the picture.
enum class FindingKind {
  kPicture,  // the accepted picture is not the one of golden.lock, or of another size
  kFault,    // the new picture contradicts what it was drawn from, or shows nothing
  kClass,    // of a load
  kJoint,    // is bent further or less; may move the camera
  kCamera,   // moves everything else
  kMissing,
  kNew,
  kText,
  kInput,  // a recording or another file
  kLoad,   // ratio
  kFloor,
  kMoved,
  kVisible,  // more or less of it
  kLight,
  kStructure,
  kPixels,
};

/// "class", "missing", ...: as in JSON.
const char* Name(FindingKind kind);
/// @throws std::runtime_error if there is none of this name.
FindingKind FindingKindNamed(const std::string& name);

struct GoldenFinding {
  FindingKind kind = FindingKind::kPixels;
  std::string object;            // "left_knee", "legend", "camera"; "picture": all of it
  std::string expected, actual;  // "": does not apply
  double amount = 0;             // px, degrees, ratio, ...; 0: does not apply
  std::string text;              // one line, with the object
  std::optional<double> x_px = std::nullopt, y_px = std::nullopt;  // where it is, or was
};

/// GoldenFinding::object of what concerns all of it.
inline constexpr char kWholePicture[] = "picture";

/// A place may differ by this, px.
inline constexpr double kPlaceLimitPx = 2;

/// What a person would name: objects, texts, cameras, floor. The worst first.
std::vector<GoldenFinding> Compare(const PictureFacts& expected, const PictureFacts& actual,
                                   double place_limit_px = kPlaceLimitPx);

/// For people: one line per object, and one for many objects with the same kind of change. In the
/// order of the findings; those of the whole picture last.
std::vector<std::string> Summarize(const std::vector<GoldenFinding>& findings);

void SortWorstFirst(std::vector<GoldenFinding>& findings);

}  // namespace kinescope::app
