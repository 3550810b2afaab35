/// `golden check`: draws every case and says whether its picture has changed, and what in it. A
/// case that cannot be compared has a verdict of its own and keeps no other case from being
/// compared.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "render/renderer.h"
#include "server/app/golden/golden_suite.h"
#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

struct CheckSettings {
  std::filesystem::path out;  // folder for the pictures of cases that are not the same
  bool is_strict = false;     // only equal bytes are the same
};

/// Calls `report` with every verdict, in the order of the suite, what belongs to no case last.
/// @throws std::runtime_error if a picture cannot be written, or when interrupted.
void CheckSuite(const GoldenSuite& suite, const CheckSettings& settings, render::Renderer& renderer,
                const std::function<void(const CaseVerdict&)>& report);

/// The pictures of a case in the folder of a run.
std::filesystem::path NewPictureOf(const std::filesystem::path& out, const std::string& name);
std::filesystem::path DifferenceOf(const std::filesystem::path& out, const std::string& name);
/// Accepted, new and difference side by side, with words.
std::filesystem::path CompositeOf(const std::filesystem::path& out, const std::string& name);

/// All that golden.lock keeps of a drawing, but for the hash of its file.
AcceptedCase Describe(const GoldenCase& golden_case, const GoldenDrawing& drawing,
                      const std::map<std::string, std::string>& environment);

}  // namespace kinescope::app
