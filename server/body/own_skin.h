/// Reads a rigged person of the user's as the skin of all people (urdf/rig). Any thread.
#pragma once

#include <filesystem>
#include <memory>

#include "urdf/skin/skin_template.h"

namespace kinescope::app {

/// A GLB file (VRM files, too). Colours that could be mistaken for those of load classes become the
/// most similar ones that could not; the log names what is not drawn.
/// @throws std::runtime_error with the reason, without the file's name.
std::shared_ptr<const skin::SkinTemplate> ReadOwnSkin(const std::filesystem::path& path);

}  // namespace kinescope::app
