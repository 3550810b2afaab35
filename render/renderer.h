/// SceneState + camera -> pixels, without a display. The drawing itself is a module that is loaded
/// when the first renderer is made, so a process that only bridges never loads VTK, Mesa or LLVM.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/image.h"
#include "render/load_history.h"
#include "render/scene_look.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

/// No GL, no module, a driver that fails. what() is one line: what was tried and the way out.
class RenderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is written over a picture, one by one; View::overlays switches all of it.
struct OverlayParts {
  bool title = true;
  bool lamp = true;    // live, recorded or stale, and the rate of samples
  bool legend = true;  // with units
  bool time = true;    // time code and sample number
  bool names = true;   // of several people, frames, boxes that stand for meshes
  bool banner = true;  // "STALE", "NO DATA"
  bool scale = false;  // a bar that is true at the depth of the camera's target
  bool strip = false;  // sample and time for machines (strip.h)
  bool plot = false;   // View::history
};

/// One of several views in a picture.
struct Pane {
  std::string name;  // written into it; "" none
  Camera camera;
};

struct View {
  int width = 1280;      // px, 16..8192
  int height = 720;      // px, 16..8192
  int supersample = 1;   // 1, 2 or 4: drawn so many times larger, then averaged
  std::string title;     // upper left; "" none
  bool overlays = true;  // legend, time code, banner
  OverlayParts parts = {};
  /// Several views in one picture, row by row, instead of the camera's (multi_view.h).
  std::vector<Pane> panes = {};
  int pane_columns = 1;
  /// For the plot, with its cursor at plot_secs.
  std::shared_ptr<const LoadHistory> history = nullptr;
  double plot_secs = 0;
  SceneLook look = {};  // theme, background, what is shown
};

enum class LayerFormat { kSvg, kPdf };

/// Takes one line without a line end: a mesh that is missing (once), a warning of the driver.
using LogLine = std::function<void(const std::string&)>;

/// Create, use and destroy it on one thread: a GL context does not migrate.
class Renderer {
 public:
  virtual ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// `state` as `camera` sees it. The same arguments give the same bytes.
  /// @throws RenderError if the driver fails; UsageError for a size out of range.
  Image Render(const SceneState& state, const Camera& camera, const View& view);

  /// The same into `image`, whose memory is used again: what a stream of pictures should call.
  void RenderInto(Image& image, const SceneState& state, const Camera& camera, const View& view);

  /// What is written over the picture that was drawn last, alone and as vectors, as large as the
  /// picture (SVG: px; PDF: 96 px to the inch). Pass what that picture was drawn with; it is made
  /// whether or not view.overlays had it painted. The same arguments give the same bytes.
  std::string OverlayLayer(const SceneState& state, const Camera& camera, const View& view,
                           LayerFormat format);

  /// The smallest upright box around all that is drawn of `robot`, world, m; empty when that is
  /// nothing. Reads its meshes, which the next picture of it then need not.
  virtual Eigen::AlignedBox3d Bounds(const RobotState& robot) = 0;

  /// What the newest picture shows as a labelled box, because its mesh is missing or was refused:
  /// one line each, naming the file and the reason. The log gets each line once.
  virtual std::vector<std::string> problems() const = 0;

  /// GL_RENDERER, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
  virtual std::string renderer_string() const = 0;

 protected:
  Renderer();

 private:
  /// `image` has the size of `view` and every pixel is to be written.
  virtual void DoRender(Image& image, const SceneState& state, const Camera& camera,
                        const View& view) = 0;
  virtual std::string DoOverlayLayer(const SceneState& state, const Camera& camera,
                                     const View& view, LayerFormat format) = 0;
  struct Owner;  // the thread that made it
  std::unique_ptr<const Owner> owner_;
};

/// Back-ends: "osmesa" (software, the default). `log` is called on the calling thread only; without
/// one, lines go to stderr.
/// Sets GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 in the environment unless it is set already: llvmpipe then
/// rounds alike on every x86-64 machine. Make the first renderer before other threads use getenv().
/// @throws RenderError naming the back-end, why it did not start and what would help.
std::unique_ptr<Renderer> MakeRenderer(const std::string& backend = "osmesa", LogLine log = {});

}  // namespace kinescope::render
