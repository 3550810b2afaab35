/// Interfaces of the modules that are loaded on demand, each with dozens of libraries: rendering
/// (VTK, Mesa, LLVM), video (libav) and plots (Cairo).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "core/system/module_loader.h"
#include "render/camera/camera.h"
#include "render/contents.h"
#include "render/image/image.h"
#include "render/line_drawing.h"
#include "render/painter.h"
#include "render/plot.h"
#include "render/renderer.h"
#include "render/scene_look.h"
#include "render/video.h"

namespace kinescope::render {

/// Description that OpenGL gives of itself.
struct Driver {
  std::string renderer;       // GL_RENDERER
  std::string gl_version;     // GL_VERSION
  std::string scene_library;  // such as "VTK 9.1.0"
};

/// Whether a driver of this GL_RENDERER draws on the processor.
inline bool IsSoftware(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast"}) {
    if (renderer.find(name) != std::string::npos) return true;
  }
  return false;
}

/// Text at a position in the world, painted by the overlay.
struct Label {
  enum class Kind {
    kName,    // of a person or an object: on a panel, moved aside from other labels
    kFault,   // of an element that could not be rendered: like kName, but never hidden
    kFloor,   // on the floor: faint, at its position
    kMarker,  // of a marker: at its position
  };
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, m
  std::string text;
  Kind kind = Kind::kName;
  double height_m = 0;  // kMarker: height of a capital there, m
  Rgb color = {0, 0, 0};
  double opacity = 1;
};

/// What is painted over a drawing.
struct DrawnScene {
  std::vector<Label> labels;
  std::vector<DrawnLine> lines;  // of Style::kLine
};

/// The 3-D picture without overlays. Belongs to the thread that made it.
class Drawing {
 public:
  virtual ~Drawing() = default;
  /// Fills `image`, which has its size already, and `drawn`. @throws RenderError.
  virtual void Draw(const SceneState& state, const Camera& camera, const SceneLook& look,
                    int supersample, Image& image, DrawnScene& drawn) = 0;
  /// What Draw() with these arguments shows in a picture of `width` x `height` px: its things, in
  /// no order. Those of shadows and floor are none. @throws RenderError.
  virtual std::vector<SeenObject> See(const SceneState& state, const Camera& camera,
                                      const SceneLook& look, int supersample, int width,
                                      int height) = 0;
  /// Box around the rendered shapes of `robot`, world, m; empty if there are none.
  virtual Eigen::AlignedBox3d Bounds(const RobotState& robot) = 0;
  /// The elements that the newest picture replaces by labelled boxes, one line each.
  virtual std::vector<std::string> problems() const = 0;
  virtual Driver driver() const = 0;
};

struct DrawingModule {
  ModuleAbi<SceneState, PersonState, PersonModel, urdf::Landmark, urdf::AddedMass, JointLoad,
            TrackedObject, LeftOutPerson, RobotState, urdf::RobotModel, urdf::Link, urdf::Visual,
            urdf::Collision, urdf::RobotJoint, urdf::MeshSearch, urdf::MeshNotFound, SceneMarker,
            CameraImage, Camera, SceneLook, Trail, Ghost, Image, Label, DrawnLine, DrawnScene,
            SeenObject, Driver, RegionSettings>
      abi;
  /// `backend`: one of those in the module.
  std::unique_ptr<Drawing> (*make)(const std::string& backend, const LogLine& log,
                                   const RegionSettings& regions);
};

struct VideoModule {
  ModuleAbi<Image, VideoOptions> abi;
  std::unique_ptr<VideoWriter> (*make)(const std::filesystem::path& path, ClipFormat format,
                                       int width, int height, const VideoOptions& options);
  std::unique_ptr<VideoReader> (*open)(const std::filesystem::path& path);
};

/// Paints into a file in place of pixels. One thread.
class LayerPainter : public Painter {
 public:
  /// The bytes of the file; call it once, at the end. @throws RenderError.
  virtual std::string Finish() = 0;
};

/// `below`: pixels under what is painted; nullptr: none. SVG has none.
/// @throws RenderError if the module or its font is missing.
std::unique_ptr<LayerPainter> MakeLayerPainter(int width_px, int height_px, double width_mm,
                                               LayerFormat format, const Image* below);

struct PlotModule {
  ModuleAbi<Plot, PlotPanel, PlotBand, PlotGap, PlotLimit, PlotCurve, PlotClassInterval, PlotFlag,
            PlotMark, PlotSwatch, PlotText, Image, Ink, Tile, Font, Glyph>
      abi;
  std::string (*svg)(const Plot& plot);
  Image (*image)(const Plot& plot, double px_per_pt);
  std::unique_ptr<LayerPainter> (*layer)(int width_px, int height_px, double width_mm,
                                         LayerFormat format, const Image* below);
};

/// Names of the entries of the modules: `extern "C"` functions without arguments.
inline constexpr const char* kDrawingEntry = "KinescopeDrawingModule";  // -> const DrawingModule*
inline constexpr const char* kVideoEntry = "KinescopeVideoModule";      // -> const VideoModule*
inline constexpr const char* kPlotEntry = "KinescopePlotModule";        // -> const PlotModule*

/// As kinescope::OpenModule. @throws RenderError.
template <class Module>
const Module& OpenModule(const std::string& file_name, const char* entry) try {
  return kinescope::OpenModule<Module>(file_name, entry);
} catch (const ModuleError& error) {
  throw RenderError(error.what());
}

}  // namespace kinescope::render
