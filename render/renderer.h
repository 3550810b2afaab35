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
#include "server/core/scene_state.h"

namespace kinescope::render {

/// No GL, no module, a driver that fails. what() is one line: what was tried and the way out.
class RenderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct View {
  int width = 1280;      // px, 16..8192
  int height = 720;      // px, 16..8192
  int supersample = 1;   // 1, 2 or 4: drawn so many times larger, then averaged
  std::string title;     // upper left; "" none
  bool overlays = true;  // legend, time code, banner
};

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
