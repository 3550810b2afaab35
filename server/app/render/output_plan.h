/// Which files `kinescope render` is to make of which source, told before anything is read.
#pragma once

#include <string>
#include <vector>

#include "server/app/render/render_options.h"

namespace kinescope::app {

enum class OutputKind {
  kStill,     // one PNG
  kSequence,  // a PNG for every picture, numbered from 0
  kClip,      // .mp4, .webm, .webp, .gif
};

struct Output {
  std::string path;  // of a sequence: with the place of the number in it
  OutputKind kind = OutputKind::kStill;
  std::string camera;  // one of those that --camera names
};

struct SourcePlan {
  std::string source;
  std::vector<Output> outputs;  // at least one
};

/// `{source}` and `{camera}` in --out are replaced; a `%05d` (as in ffmpeg) or `#####` (as in
/// Blender) before .png makes a sequence. Folders are there and can be written, no name comes up
/// twice, options fit what is made.
/// @throws UsageError naming option, value and what was expected.
std::vector<SourcePlan> PlanOutputs(const RenderOptions& options);

/// The path of picture `k`, counted from 0, of a sequence.
std::string PathOfPicture(const std::string& pattern, long k);

/// Whether a clip of that name is packed to a constant quality (--crf), or to --quality.
bool HasCrf(const std::string& path);
bool HasQuality(const std::string& path);

/// "front,top" -> front, top. Commas within parentheses, and those that are followed by a digit, a
/// sign or a point, belong to the camera.
std::vector<std::string> SplitCameras(const std::string& text);

}  // namespace kinescope::app
