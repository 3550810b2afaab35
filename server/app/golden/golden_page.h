/// A golden case that is a web page: any address, or our own dashboard at a moment of a recording,
/// drawn by Chromium. What a person reads on it takes the place of the objects of a scene.
#pragma once

#include <filesystem>

#include "server/app/golden/golden_case.h"

namespace kinescope::app {

/// The page of the dashboard, in the key `page`; an address follows it as in "dashboard?view=wall".
inline constexpr char kDashboard[] = "dashboard";

/// @throws UsageError with file and key where keys do not fit together.
void CheckPage(const GoldenCase& golden_case, const std::filesystem::path& yaml);

/// @throws std::runtime_error as DrawPage() and DrawDashboard().
GoldenDrawing DrawPageOf(const GoldenCase& golden_case);

}  // namespace kinescope::app
