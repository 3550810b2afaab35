/// Text description of the load spheres in a golden picture (`<case>.objects.json`). It is compared
/// before any pixel, so that a changed load is reported with its joint and not as "412 pixels
/// differ". Pure functions except for reading the file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/camera/spheres.h"

namespace kinescope::app {

/// One object per line: joint, class, ratio (three digits), centre and radius in px (one digit).
std::string ToJson(const std::vector<render::SphereInPicture>& spheres);

/// @throws std::runtime_error with file and reason.
std::vector<render::SphereInPicture> ReadObjects(const std::filesystem::path& path);

/// One line per object that is missing, new, of another class, with a ratio that differs by more
/// than 0.005, or moved by more than 1 px. Empty: the same objects.
std::vector<std::string> FindObjectChanges(const std::vector<render::SphereInPicture>& expected,
                                           const std::vector<render::SphereInPicture>& actual);

}  // namespace kinescope::app
