/// One golden case: what to draw, as `golden_images/<name>.yaml` says it, and the drawing of it.
///
///     source: demo:lift       # or pose:right_elbow=90, or a file, relative to the case
///     time: 2.5               # s after the first sample
///     seconds: 2              # a clip: its length
///     state: live             # live | stale | no data
///     camera: front
///     size: 640x360
///     supersample: 2
///     mask: [160x40+20+300 the clock of the lab]
///     tolerance: [light 2 the new driver rounds otherwise]
///     why: the purpose of the case in one line, shown when it fails
///
/// Files are relative to the case.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/camera/spheres.h"
#include "render/frame_code.h"
#include "render/image/image.h"
#include "render/renderer.h"
#include "server/app/golden/golden_frame.h"
#include "server/app/golden/golden_limits.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/picture_facts.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

struct GoldenCase {
  GoldenCase();

  std::string name;  // of the file, without .yaml
  options::Text source;
  options::Text page;               // "": a scene (golden_page.h)
  std::filesystem::path page_file;  // of a page that is a file; ""
  options::Number time;             // s
  /// Of a clip, which begins at `time`: of its pictures, every n-th is compared.
  options::Optional<options::Number> seconds;
  options::Number fps;
  options::Whole every;
  options::Choice<Liveness> state;
  MasksValue masks;
  LimitsValue limits;
  options::Text why;
  options::FilePath rviz;
  ViewOptions view;
  PersonOptions person;
  LoadOptions loads;
  /// What the file sets, but for `why`, as it sets it.
  std::map<std::string, nlohmann::json> given;
  std::map<std::string, int> lines;  // of the file, by key

  void List(options::OptionList& option);
};

/// @throws UsageError naming file, line and key.
GoldenCase LoadGoldenCase(const std::filesystem::path& yaml);

/// The files that the case reads. @throws SourceError if one cannot be read.
std::vector<InputFact> InputsOf(const GoldenCase& golden_case);

struct GoldenDrawing {
  std::optional<GoldenFrame> frame;  // of a clip
  render::Image image;
  /// Several views: "<view>/<joint>", those that lie wholly within their view.
  std::vector<render::SphereInPicture> spheres;
  std::optional<render::FrameCode> frame_code;  // what the picture must contain
  PictureFacts facts;
  std::vector<ObjectPlace> places;  // of the objects of the facts
  std::vector<Mask> masks;          // besides those of the case
  /// What pixels depend on; empty: the renderer.
  std::map<std::string, std::string> environment;
};

/// One picture; of a clip, the pictures in order, drawn as the clip is, one after the other.
/// @throws std::exception with the reason; some pictures may have been drawn then.
void Draw(const GoldenCase& golden_case, render::Renderer& renderer,
          const std::function<void(GoldenDrawing)>& on_drawing);

}  // namespace kinescope::app
