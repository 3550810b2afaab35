#include "render/renderer.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "core/system/utf8.h"
#include "render/module_renderer.h"
#include "render/shader_cache.h"

namespace kinescope::render {

struct Renderer::Owner {
  const std::thread::id thread = std::this_thread::get_id();
};

namespace {

void CheckSpec(const PictureSpec& spec) {
  const auto check_side = [](const char* name, int value) {
    if (value >= kMinPictureSide && value <= kMaxPictureSide) return;
    throw UsageError(std::string("picture ") + name + " " + std::to_string(value) + ": expected " +
                     std::to_string(kMinPictureSide) + " to " + std::to_string(kMaxPictureSide) +
                     " px");
  };
  check_side("width", spec.width);
  check_side("height", spec.height);
  const auto& factors = kSupersampleFactors;
  if (std::find(factors.begin(), factors.end(), spec.supersample) == factors.end()) {
    throw UsageError("--supersample=" + std::to_string(spec.supersample) + ": expected 1, 2 or 4");
  }
  const Tile scene = spec.SceneTile();
  KINESCOPE_CHECK(scene.x >= 0 && scene.y >= 0 && scene.width > 0 && scene.height > 0);
  KINESCOPE_CHECK(scene.x + scene.width <= spec.width && scene.y + scene.height <= spec.height);
  KINESCOPE_CHECK(!spec.scene || spec.legend_content != nullptr);
}

void CheckCamera(const Camera& camera) {
  const bool is_finite = camera.position.allFinite() && camera.target.allFinite() &&
                         camera.up.allFinite() && std::isfinite(camera.vertical_fov_rad);
  if (!is_finite) throw RenderError("the position or direction of the camera is not finite");
}

// Mesa asks for the same megabytes for every picture. Otherwise glibc gives them back each time,
// and a twentieth of the time goes into page faults.
void KeepFreedMemory() {
  constexpr int kThreshold = 4 << 20;  // bytes
  ::mallopt(M_MMAP_THRESHOLD, kThreshold);
  ::mallopt(M_TRIM_THRESHOLD, kThreshold);
}

void ToStderr(const std::string& line) {
  std::fprintf(stderr, "render: %s\n", PrintableLine(line).c_str());
}

const DrawingModule& ModuleOf(const std::string& backend) {
  const char* file =
      backend == "osmesa" ? "libkinescope_render_osmesa.so" : "libkinescope_render_egl.so";
  return OpenModule<DrawingModule>(file, kDrawingEntry);
}

// GLEW's table of functions, VTK's direct calls and Mesa's choice of a driver are the process'.
const DrawingModule& OnlyModule(const std::string& backend) {
  static std::mutex mutex;
  static std::string first;
  const std::lock_guard<std::mutex> lock(mutex);
  if (!first.empty() && first != backend) {
    throw RenderError("back-end '" + backend + "' cannot be used: this process already uses '" +
                      first + "', and only one is possible per process; start another process");
  }
  const DrawingModule& module = ModuleOf(backend);
  first = backend;
  return module;
}

}  // namespace

Renderer::Renderer() : owner_(std::make_unique<const Owner>()) {}

Renderer::~Renderer() { KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread); }

Image Renderer::Render(const SceneState& state, const Camera& camera, const PictureSpec& spec) {
  Image image;
  RenderInto(image, state, camera, spec);
  return image;
}

void Renderer::RenderInto(Image& image, const SceneState& state, const Camera& camera,
                          const PictureSpec& spec) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckSpec(spec);
  CheckCamera(camera);
  for (const Pane& pane : spec.panes) CheckCamera(pane.camera);
  SetSize(image, spec.width, spec.height);
  DoRender(image, state, camera, spec);
  image.is_opaque = !spec.look.is_transparent;
}

std::string Renderer::OverlayLayer(const SceneState& state, const Camera& camera,
                                   const PictureSpec& spec, LayerFormat format) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckSpec(spec);
  return DoOverlayLayer(state, camera, spec, format);
}

PictureContents Renderer::Contents(const SceneState& state, const Camera& camera,
                                   const PictureSpec& spec) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckSpec(spec);
  return DoContents(state, camera, spec);
}

const std::vector<std::string>& BackendNames() {
  static const std::vector<std::string> names = {"osmesa", "egl", "egl_device"};
  return names;
}

bool HasBackend(const std::string& backend) {
  try {
    ModuleOf(backend);
    return true;
  } catch (const RenderError&) {
    return false;
  }
}

std::chrono::milliseconds LimitOf(const PictureSpec& spec) {
  // The first picture compiles shaders: that is in the seconds, whatever the size.
  constexpr double kSecs = 30, kSecsPerPixel = 1e-6;
  const double pixels = 1.0 * spec.width * spec.height * spec.supersample * spec.supersample;
  return std::chrono::milliseconds(
      static_cast<std::chrono::milliseconds::rep>(1000 * (kSecs + kSecsPerPixel * pixels)));
}

void UseFillingThreads(int count) { ::setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 0); }

void PreferSpeed() {
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "avx", 0);
  UseFillingThreads(1);
}

std::unique_ptr<Renderer> MakeRenderer(RendererSettings settings) {
  const auto& names = BackendNames();
  if (std::find(names.begin(), names.end(), settings.backend) == names.end()) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    throw RenderError("unknown back-end '" + settings.backend + "'; expected one of " + known);
  }
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1", 0);
  KeepFreedMemory();
  if (settings.backend == "egl") ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
  if (!settings.log) settings.log = ToStderr;
  if (const char* every = std::getenv("KINESCOPE_CHECK_REGIONS")) {
    settings.regions.check_every = std::atoi(every);
  }
  const std::string cache_note = PrepareShaderCache();
  if (!cache_note.empty()) settings.log(cache_note);
  const DrawingModule& module = OnlyModule(settings.backend);
  return std::make_unique<ModuleRenderer>(module, std::move(settings));
}

std::unique_ptr<Renderer> MakeRenderer(const std::string& backend, LogLine log) {
  RendererSettings settings;
  settings.backend = backend;
  settings.log = std::move(log);
  return MakeRenderer(std::move(settings));
}

}  // namespace kinescope::render
