/// `kinescope render --verify`: is a file what its provenance says?
#pragma once

#include <string>

#include "server/app/render/render_options.h"

namespace kinescope::app {

/// Draws `file` (a picture, a clip, a sequence by its pattern, or one picture of it) again from its
/// provenance and compares. Of `given` only the source (in place of where it was), jobs and json
/// count. 0: the same; 1: not, and a picture of the differences lies beside the file.
///
/// The same is: no pixel differs, where the renderer is the one that drew the file; by no more than
/// rounding (render::kChannelTolerance) where it is another. A clip is the same when its bytes are;
/// else its pictures are decoded, and fewer than 1 in 1000 pixels of any may differ by more than 24
/// levels, since another version of an encoder packs differently.
/// @throws UsageError, SourceError, std::runtime_error: could not.
int Verify(const std::string& file, const RenderOptions& given);

}  // namespace kinescope::app
