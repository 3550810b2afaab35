/// Renders a SceneState as seen by a camera to pixels, without a display. The rendering code is a
/// module that is loaded with the first renderer, so a process that only bridges never loads VTK,
/// Mesa or LLVM.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/picture_limits.h"
#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/contents.h"
#include "render/image/image.h"
#include "render/image/tile.h"
#include "render/legend.h"
#include "render/load_curves.h"
#include "render/overlay_parts.h"
#include "render/scene_look.h"

namespace kinescope::render {

/// OpenGL or the module is not available, or the driver fails. what() is one line: what was tried
/// and the remedy.
class RenderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a view shows that is of a moment of its own.
struct PaneScene {
  SceneState state;
  std::vector<Trail> trails;
  std::vector<Ghost> ghosts;
};

/// One of several views in a picture.
struct Pane {
  std::string name;  // shown in the view; "": none
  Camera camera;
  std::shared_ptr<const PaneScene> scene = nullptr;  // nullptr: the picture's
};

inline constexpr double kMmPerInch = 25.4, kPointsPerInch = 72;

/// How large a picture is printed.
struct PrintSize {
  double width_mm = 0;  // 0: not known; texts follow the height of the picture then
  double text_pt = 7;   // the smallest text, at that width

  bool is_known() const { return width_mm > 0; }
  /// Of a picture that is `width_px` wide. @pre is_known()
  double PixelsPerPoint(int width_px) const {
    return width_px / (width_mm / kMmPerInch * kPointsPerInch);
  }
  /// 0 if it is not known.
  double PixelsPerMetre(int width_px) const { return is_known() ? 1000 * width_px / width_mm : 0; }
};

/// Where the legend is, if OverlayParts::legend is on.
enum class LegendPlace {
  kInside,   // over the scene
  kBelow,    // in a strip under it
  kOutside,  // in a column to its right
};

struct PictureSpec {
  int width = kDefaultPictureWidth;    // px, kMinPictureSide to kMaxPictureSide
  int height = kDefaultPictureHeight;  // px, kMinPictureSide to kMaxPictureSide
  int supersample = 1;        // one of kSupersampleFactors: of pixels drawn, in each direction
  std::string title;          // upper left; "": none
  bool overlays = true;       // legend, time code, banner
  bool marker_texts = false;  // without overlays: those of markers and frames all the same
  bool lines = true;          // those of Style::kLine; false: they are left to OverlayLayer
  OverlayParts parts = {};
  /// Several views in one picture, row by row (multi_view.h); they replace the camera argument.
  std::vector<Pane> panes = {};
  int pane_columns = 1;
  /// For the plot; its cursor is at plot_secs.
  std::shared_ptr<const LoadCurves> load_curves = nullptr;
  double plot_secs = 0;
  std::vector<std::string> marks = {};  // captions of what was marked at this time, oldest first
  SceneLook look = {};                  // theme, background, visible elements
  PrintSize print = {};
  LegendPlace legend = LegendPlace::kInside;
  /// What the legend lists; nullptr: what the picture shows. Fixed for a whole clip by
  /// PlaceLegend().
  std::shared_ptr<const LegendContent> legend_content = nullptr;
  /// The part of the picture that shows the scene; nullopt: all of it. The rest has the colour of
  /// the background. PlaceLegend() sets it.
  std::optional<Tile> scene = std::nullopt;

  Tile SceneTile() const { return scene.value_or(Tile{0, 0, width, height}); }
};

/// Whether texts have room. If not, only the status indicator, names and banners are painted.
bool HasRoomForTexts(const PictureSpec& spec);

enum class LayerFormat {
  kSvg,
  kPdf,
  kPdfPage,  // with the picture under it, as pixels
};

/// Receives one line without a line end: a missing mesh (once), a warning of the driver.
using LogLine = std::function<void(const std::string&)>;

/// The rendering back-end, and its description of itself.
struct RendererInfo {
  std::string backend;     // as requested: "osmesa", ...
  std::string renderer;    // GL_RENDERER, such as "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string gl_version;  // GL_VERSION
  bool is_software = false;
  std::string note;                // RendererSettings::note
  std::string scene_library = {};  // such as "VTK 9.1.0"
};

/// Create, use and destroy it on one thread: a GL context belongs to one thread.
class Renderer {
 public:
  virtual ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// `state` as `camera` sees it. Equal arguments give equal bytes.
  /// @throws RenderError if the driver fails; UsageError for a size out of range.
  Image Render(const SceneState& state, const Camera& camera, const PictureSpec& spec);

  /// As Render, into `image`, whose memory is reused: for streams of pictures.
  void RenderInto(Image& image, const SceneState& state, const Camera& camera,
                  const PictureSpec& spec);

  /// The overlays (if spec.overlays is set) and lines of the picture rendered last, alone and as
  /// vectors, in its size (SVG: px; PDF: 96 px per inch). Pass the arguments of that picture, which
  /// may have been rendered without overlays and lines. Equal arguments give equal bytes. With
  /// LayerFormat::kPdfPage the picture is rendered again, without overlays and lines.
  std::string OverlayLayer(const SceneState& state, const Camera& camera, const PictureSpec& spec,
                           LayerFormat format);

  /// What the picture rendered last shows. Pass the arguments of that picture.
  /// @throws RenderError if the driver fails.
  PictureContents Contents(const SceneState& state, const Camera& camera, const PictureSpec& spec);

  /// The smallest axis-aligned box around the rendered shapes of `robot`, world, m; empty if there
  /// are none. Reads its meshes, so that the next picture need not.
  virtual Eigen::AlignedBox3d Bounds(const RobotState& robot) = 0;

  /// Elements that the newest picture does not show properly: meshes that are missing or rejected
  /// (shown as labelled boxes), people with a pose that is not finite (not shown). One line each,
  /// with the reason. Each line is logged once.
  virtual std::vector<std::string> problems() const = 0;

  virtual RendererInfo info() const = 0;
  std::string renderer_string() const { return info().renderer; }

 protected:
  Renderer();

 private:
  /// `image` has the size of `spec`; every pixel must be written.
  virtual void DoRender(Image& image, const SceneState& state, const Camera& camera,
                        const PictureSpec& spec) = 0;
  virtual std::string DoOverlayLayer(const SceneState& state, const Camera& camera,
                                     const PictureSpec& spec, LayerFormat format) = 0;
  virtual PictureContents DoContents(const SceneState& state, const Camera& camera,
                                     const PictureSpec& spec) = 0;
  struct Owner;  // the thread that made it
  std::unique_ptr<const Owner> owner_;
};

/// The back-ends of MakeRenderer: osmesa (software in memory), egl (Mesa's software through EGL,
/// without a surface), egl_device (a GPU through EGL_EXT_platform_device).
const std::vector<std::string>& BackendNames();

/// Whether the libraries of `backend` are installed. It loads them, so call it only for the
/// back-end that will be used.
bool HasBackend(const std::string& backend);

/// While the camera stands still, software back-ends draw only the part of a picture that may
/// differ from its floor. The bytes are the same.
struct RegionSettings {
  bool is_off = false;  // draws every picture whole
  /// To find an actor that is drawn outside of the part that it reports: every n-th of these
  /// pictures is also drawn whole. If it differs, rendering throws RenderError with the actor's
  /// name. 0: none is.
  int check_every = 0;
  double margin_px = 1;  // around what actors report; tests of the check take some away
};

struct RendererSettings {
  std::string backend = "osmesa";
  /// Called on the renderer's thread only; by default lines go to stderr. Receives the warnings of
  /// VTK, OpenGL and EGL, one line each.
  LogLine log;
  /// For RendererInfo: why a better back-end was not used; "": nothing to report.
  std::string note;
  RegionSettings regions = {};  // KINESCOPE_CHECK_REGIONS in the environment sets check_every
  /// Time limit of the driver per picture; 0: LimitOf() it.
  std::chrono::milliseconds limit{0};
  /// Called on another thread when the limit is exceeded. A driver cannot be interrupted, so the
  /// rendering call still waits for it. By default the process ends with this line and exit code 2.
  std::function<void(const std::string& line)> on_hang;
};

/// Thousands of times the rendering time of a picture of this size on a slow core; beyond it the
/// driver counts as hanging.
std::chrono::milliseconds LimitOf(const PictureSpec& spec);

/// The number of threads on which llvmpipe fills pixels for one renderer, beside the thread that
/// draws; 0: that thread fills them. Sets LP_NUM_THREADS in the environment unless it is set. Does
/// not change a pixel. Call it before the first renderer of the process.
void UseFillingThreads(int count);

/// For pictures that are looked at and not compared: llvmpipe may use AVX where the processor has
/// it, which takes a seventh of the time off; a few pixels differ by one level then. It has one
/// thread beside ours: more save little time, and cost a twelfth more to wake up. Sets
/// GALLIUM_OVERRIDE_CPU_CAPS=avx and LP_NUM_THREADS=1 in the environment unless they are set. Call
/// it before the first renderer of the process.
void PreferSpeed();

/// Sets GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 in the environment unless it is set, so that llvmpipe
/// rounds alike on every x86-64 machine; for "egl" also LIBGL_ALWAYS_SOFTWARE=1. Switches Mesa's
/// cache of shaders off if its disk is full (shader_cache.h). Make the first
/// renderer before other threads call getenv(). A process can use only one kind of back-end,
/// because VTK has one table of GL functions per process.
/// @throws RenderError with the back-end, why it did not start and the remedy.
std::unique_ptr<Renderer> MakeRenderer(RendererSettings settings);
std::unique_ptr<Renderer> MakeRenderer(const std::string& backend = "osmesa", LogLine log = {});

}  // namespace kinescope::render
