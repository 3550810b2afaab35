/// SceneState + camera -> pixels, without a display. The drawing itself is a module that is loaded
/// when the first renderer is made, so a process that only bridges never loads VTK, Mesa or LLVM.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/load_history.h"
#include "render/scene_look.h"

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

/// Which way to a GL context draws, and what was found there.
struct RendererInfo {
  std::string backend;     // as asked for: "osmesa", ...
  std::string renderer;    // GL_RENDERER, such as "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string gl_version;  // GL_VERSION
  bool is_software = false;
  std::string note;  // RendererSettings::note
};

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

  /// What the newest picture does not show as it is: a labelled box for a mesh that is missing or
  /// was refused, nobody for a person whose pose is not finite. One line each, naming it and the
  /// reason. The log gets each line once.
  virtual std::vector<std::string> problems() const = 0;

  virtual RendererInfo info() const = 0;
  std::string renderer_string() const { return info().renderer; }

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

/// The back-ends that MakeRenderer knows: osmesa (software in memory), egl (Mesa's software through
/// EGL, without a surface), egl_device (a GPU through EGL_EXT_platform_device).
const std::vector<std::string>& BackendNames();

/// Whether the libraries of `backend` are here. Loads them, so ask only for the one to be used
/// then.
bool HasBackend(const std::string& backend);

struct RendererSettings {
  std::string backend = "osmesa";
  /// Called on the renderer's thread only; without one, lines go to stderr. Warnings of VTK, OpenGL
  /// and EGL come here, one line each.
  LogLine log;
  /// For RendererInfo: why it is this back-end and no better one; "" when there is nothing to say.
  std::string note;
  /// How long the driver may take for a picture; 0: LimitOf() it.
  std::chrono::milliseconds limit{0};
  /// Called on another thread when it takes longer; a driver cannot be interrupted, so the call
  /// that waits for it still does. Without one, the process ends with this line and exit code 2.
  std::function<void(const std::string& line)> on_hang;
};

/// Thousands of times what a picture of this size takes on a slow core: longer is a driver that
/// hangs.
std::chrono::milliseconds LimitOf(const View& view);

/// Sets GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 in the environment unless it is set already: llvmpipe then
/// rounds alike on every x86-64 machine; and for "egl" LIBGL_ALWAYS_SOFTWARE=1. Make the first
/// renderer before other threads use getenv(). A process has one kind of back-end: VTK's table of
/// GL functions is the process'.
/// @throws RenderError naming the back-end, why it did not start and what would help.
std::unique_ptr<Renderer> MakeRenderer(RendererSettings settings);
std::unique_ptr<Renderer> MakeRenderer(const std::string& backend = "osmesa", LogLine log = {});

}  // namespace kinescope::render
