/// A golden case that is a web page: any address, or our own dashboard at a moment of a recording,
/// drawn by Chromium. What a person reads on it takes the place of the objects of a scene.
#pragma once

#include <filesystem>
#include <string>

#include "server/app/golden/golden_case.h"

namespace kinescope::app {

/// The page of the dashboard, in the key `page`; an address follows it as in "dashboard?view=wall".
inline constexpr char kDashboard[] = "dashboard";

/// Whether the key `page` names our dashboard.
bool IsDashboard(const std::string& page);

/// Whether the key `page` names a file: neither an address nor the dashboard.
bool IsPageFile(const std::string& page);

/// Makes the key `page` of the case an address: a file of it is relative to the case. @throws
/// UsageError with file and key where there is no such file, or keys do not fit together.
void ResolvePage(GoldenCase& golden_case, const std::filesystem::path& yaml);

/// @throws std::runtime_error as DrawPage() and DrawDashboard().
GoldenDrawing DrawPageOf(const GoldenCase& golden_case);

}  // namespace kinescope::app
