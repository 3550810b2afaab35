/// Implements `kinescope render --verify`: checks a file against its provenance. One thread.
#pragma once

#include <string>

#include "server/app/render/render_options.h"

namespace kinescope::app {

/// Renders `file` (a picture, a clip, a sequence given by its pattern, or one picture of it) again
/// from its provenance and compares. Of `given`, only the source (which replaces the original
/// path), jobs and json are used. Returns 0 if the pictures are the same; else 1, and writes a
/// picture of the differences beside the file.
///
/// Pictures are the same if no pixel differs; with another renderer than that of the file, up to
/// rounding (render::kChannelTolerance). Clips are the same if their bytes are; otherwise they are
/// decoded, and in every picture fewer than 1 in 1000 pixels may differ by more than 24 levels,
/// because another version of an encoder encodes differently.
/// @throws UsageError, SourceError, std::runtime_error if the check is not possible.
int Verify(const std::string& file, const RenderOptions& given);

}  // namespace kinescope::app
