/// What a golden picture shows, in words: `<case>.objects.json`. Compared before any pixel, so that
/// a changed load fails by the joint's name and not as "412 pixels differ".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/spheres.h"

namespace kinescope::app {

/// One object a line: joint, class, ratio (three digits), centre and radius in px (one digit).
std::string ToJson(const std::vector<render::SphereInPicture>& spheres);

/// @throws std::runtime_error naming file and reason.
std::vector<render::SphereInPicture> ReadObjects(const std::filesystem::path& path);

/// One line for each object that is missing, new, of another class, of a ratio that differs by more
/// than 0.005, or more than 1 px elsewhere. Empty: the same objects.
std::vector<std::string> FindObjectChanges(const std::vector<render::SphereInPicture>& expected,
                                           const std::vector<render::SphereInPicture>& actual);

}  // namespace kinescope::app
