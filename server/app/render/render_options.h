/// What `kinescope render` is asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/video.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// Which moment a picture shows.
struct MomentOptions {
  std::optional<long> frame;
  std::optional<double> time;
  std::string overlay_layer;

  template <class Option>
  void Visit(Option&& option) {
    option("frame", frame, "of one picture: which sample of the motion, from 0 (the default)");
    option("time", time, "of one picture: seconds after the first sample, between samples too");
    option("overlay_layer", overlay_layer,
           "of one picture: svg or pdf; what is written over it goes into a file beside it");
  }
};

/// Which part of the motion a clip or a sequence shows, and how often.
struct ClipOptions {
  std::string fps = "30";
  double start = 0;
  std::optional<double> seconds, end;

  template <class Option>
  void Visit(Option&& option) {
    option("fps", fps, "pictures a second: 30, 12.5, 29.97 or 30000/1001");
    option("start", start, "where the clip begins, s after the first sample");
    option("seconds", seconds, "how long it is; default: to the end (demo: 10)");
    option("end", end, "where it ends, s after the first sample, in place of --seconds");
  }
};

/// How a clip is packed.
struct PackOptions {
  std::optional<int> crf;
  int quality = render::VideoOptions().quality;

  template <class Option>
  void Visit(Option&& option) {
    option("crf", crf,
           "constant quality, less is better: .mp4 0 (lossless) to 51, default 18; .webm 0 to 63, "
           "default 24");
    option("quality", quality, "of .webp, 0 to 100, more is better; 100 is lossless");
  }
};

struct RenderOptions {
  std::vector<std::string> sources, outs;
  MomentOptions moment;
  ClipOptions clip;
  PackOptions pack;
  ViewOptions view;
  BackendOptions backend;
  PersonOptions person;
  LoadOptions loads;
  int jobs = 0;  // 0: as many as are fastest here
  bool force = false;
  bool no_sidecar = false;
  bool json = false;
};

/// "svg", "pdf". @throws UsageError.
render::LayerFormat ToLayerFormat(const std::string& text);

/// "30", "12.5", "30000/1001"; 23.976, 29.97, 59.94 and the like mean their exact n * 1000 / 1001.
/// @throws UsageError.
render::FrameRate ParseFrameRate(const std::string& text);

/// The pictures of a clip: number k shows the moment `start_nanos` + NanosOf(k) after the first
/// sample, and there are those before `length_nanos`, or all that the source has.
struct TimeGrid {
  render::FrameRate rate;
  std::int64_t start_nanos = 0;
  std::optional<std::int64_t> length_nanos;

  std::int64_t NanosOf(long k) const { return start_nanos + rate.NanosOf(k); }
  bool Has(long k) const { return !length_nanos || rate.NanosOf(k) < *length_nanos; }
  /// How many; nullopt where the source decides.
  std::optional<long> count() const;
};

/// `is_endless`: of a source that never ends a clip has 10 s unless told otherwise.
/// @throws UsageError naming option, value and what was expected.
TimeGrid ToTimeGrid(const ClipOptions& options, bool is_endless);

}  // namespace kinescope::app
