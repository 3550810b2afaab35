/// One golden case: what to draw, as `golden_images/<name>.yaml` says it, and the drawing of it.
///
///     source: demo:lift       # or pose:right_elbow=90, or a file, relative to the case
///     time: 2.5               # s after the first sample
///     state: live             # live | stale | no data
///     camera: front
///     size: 640x360
///     supersample: 2
///     why: the purpose of the case in one line, shown when it fails
///
/// Files are relative to the case.
#pragma once

#include <filesystem>
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
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/picture_facts.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

struct GoldenCase {
  GoldenCase();

  std::string name;  // of the file, without .yaml
  options::Text source;
  options::Number time;  // s
  options::Choice<Liveness> state;
  options::Text why;
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
  render::Image image;
  /// Several views: "<view>/<joint>", those that lie wholly within their view.
  std::vector<render::SphereInPicture> spheres;
  std::optional<render::FrameCode> frame_code;  // what the picture must contain
  PictureFacts facts;
};

GoldenDrawing Draw(const GoldenCase& golden_case, render::Renderer& renderer);

}  // namespace kinescope::app
