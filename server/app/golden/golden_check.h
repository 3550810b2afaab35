/// Draws a golden case and says whether its picture has changed, and what in it. A case that cannot
/// be compared has a verdict, too.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/app/golden/golden_suite.h"
#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

struct CheckSettings {
  std::filesystem::path out;  // folder for the pictures of cases that are not the same
  bool is_strict = false;     // only equal bytes are the same
  bool keeps_all = false;     // writes the pictures of cases that are the same, too
};

/// Draws a case and compares it: one verdict, or of a clip one for each picture, and for each that
/// is accepted and not drawn. `environment`: EnvironmentOf() the renderer. @throws
/// std::runtime_error if a picture cannot be written.
std::vector<CaseVerdict> CheckCase(const GoldenSuite& suite, const FoundCase& found,
                                   const CheckSettings& settings,
                                   const std::map<std::string, std::string>& environment,
                                   render::Renderer& renderer);

/// Of the files that belong to no case.
std::vector<CaseVerdict> VerdictsOfNoCase(const GoldenSuite& suite);

/// The pictures of a case in the folder of a run.
std::filesystem::path NewPictureOf(const std::filesystem::path& out, const std::string& name);
std::filesystem::path DifferenceOf(const std::filesystem::path& out, const std::string& name);
/// Accepted, new and difference side by side, with words.
std::filesystem::path CompositeOf(const std::filesystem::path& out, const std::string& name);

}  // namespace kinescope::app
