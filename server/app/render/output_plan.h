/// Plans which files `kinescope render` makes from which source, before anything is read. Reads the
/// file system. Any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/render/render_options.h"

namespace kinescope::app {

enum class OutputKind {
  kStill,     // one PNG
  kSequence,  // one PNG per picture, numbered from 0
  kClip,      // .mp4, .webm, .webp, .gif
};

struct Output {
  std::string path;  // of a sequence: with a placeholder for the number
  OutputKind kind = OutputKind::kStill;
  std::string camera;  // one of those in --camera
};

struct SourcePlan {
  std::string source;
  std::vector<Output> outputs;  // at least one
};

/// Replaces `{source}` and `{camera}` in --out; a `%05d` (as in ffmpeg) or `#####` (as in Blender)
/// before .png makes a sequence. Checks that the folders exist and are writable, that no name
/// occurs twice, and that the options fit the outputs.
/// @throws UsageError with option, value and expected form.
std::vector<SourcePlan> PlanOutputs(const RenderOptions& options);

/// The path of picture `k`, from 0, of a sequence.
std::string PathOfPicture(const std::string& pattern, long k);

/// What stands for a source and for a camera in the name of an output.
std::string NameOfSource(const std::string& source);
std::string NameOfCamera(const std::string& camera);

/// The file of the overlays of a picture as vectors (--overlay_layer); "" without.
std::string LayerPathOf(const RenderOptions& options, const Output& output);

/// Whether all of them are single pictures, as far as their endings tell.
bool AreStills(const std::vector<std::string>& outs);

/// Whether a clip with that name is encoded to a constant quality (--crf), or to --quality.
bool HasCrf(const std::string& path);
bool HasQuality(const std::string& path);

}  // namespace kinescope::app
