#include "render/renderer.h"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "render/canvas.h"
#include "render/floor_lift.h"
#include "render/matte.h"
#include "render/module.h"
#include "render/multi_view.h"
#include "render/overlay.h"
#include "server/core/check.h"
#include "server/core/errors.h"

namespace kinescope::render {

struct Renderer::Owner {
  const std::thread::id thread = std::this_thread::get_id();
};

namespace {

constexpr int kSmallestSide = 16;
constexpr int kLargestSide = 8192;

void SetSize(Image& image, int width, int height) {
  image.width = width;
  image.height = height;
  image.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

void CheckView(const View& view) {
  const auto check_side = [](const char* name, int value) {
    if (value >= kSmallestSide && value <= kLargestSide) return;
    throw UsageError(std::string("a picture's ") + name + " is " + std::to_string(kSmallestSide) +
                     " to " + std::to_string(kLargestSide) + " px, not " + std::to_string(value));
  };
  check_side("width", view.width);
  check_side("height", view.height);
  if (view.supersample != 1 && view.supersample != 2 && view.supersample != 4) {
    throw UsageError("supersample is 1, 2 or 4, not " + std::to_string(view.supersample));
  }
}

// The picture's arguments raised so that the floor is at z = 0, where the drawing has it.
class Lifted {
 public:
  Lifted(const SceneState& state, const Camera& camera, const View& view)
      : state_(state), camera_(camera), view_(view) {
    if (state.floor_z == 0) return;
    raised_.emplace(Raised{state, camera, view});
    LiftToFloor(raised_->state, raised_->camera, raised_->view);
  }

  const SceneState& state() const { return raised_ ? raised_->state : state_; }
  const Camera& camera() const { return raised_ ? raised_->camera : camera_; }
  const View& view() const { return raised_ ? raised_->view : view_; }

 private:
  struct Raised {
    SceneState state;
    Camera camera;
    View view;
  };
  const SceneState& state_;
  const Camera& camera_;
  const View& view_;
  std::optional<Raised> raised_;
};

// Drawing by a module, overlays by us.
class ModuleRenderer : public Renderer {
 public:
  explicit ModuleRenderer(std::unique_ptr<Drawing> drawing) : drawing_(std::move(drawing)) {}

  std::string renderer_string() const override { return drawing_->renderer_string(); }
  Eigen::AlignedBox3d Bounds(const RobotState& robot) override { return drawing_->Bounds(robot); }
  std::vector<std::string> problems() const override { return drawing_->problems(); }

 private:
  void DoRender(Image& image, const SceneState& state, const Camera& camera,
                const View& view) override {
    const Lifted lifted(state, camera, view);
    if (lifted.view().look.is_transparent) return RenderTransparent(image, lifted);
    RenderOpaque(image, lifted.state(), lifted.camera(), lifted.view());
  }

  std::string DoOverlayLayer(const SceneState& state, const Camera& camera, const View& view,
                             LayerFormat format) override {
    const Lifted lifted(state, camera, view);
    std::vector<DrawnView> views = ViewsOf(lifted.camera(), lifted.view());
    KINESCOPE_CHECK(views.size() == drawn_.size());  // of the picture drawn last
    for (std::size_t i = 0; i < views.size(); ++i) views[i].labels = drawn_[i].labels;
    const auto painter = MakeLayerPainter(view.width, view.height, format);
    overlay_.Paint(*painter, lifted.state(), views, lifted.view());
    return painter->Finish();
  }

  static std::vector<DrawnView> ViewsOf(const Camera& camera, const View& view) {
    if (view.panes.empty()) return {{{0, 0, view.width, view.height}, camera, "", {}}};
    const auto tiles =
        PaneTiles(view.width, view.height, static_cast<int>(view.panes.size()), view.pane_columns);
    std::vector<DrawnView> views;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      views.push_back({tiles[i], view.panes[i].camera, view.panes[i].name, {}});
    }
    return views;
  }

  void RenderOpaque(Image& image, const SceneState& state, const Camera& camera, const View& view) {
    std::optional<SceneState> shown;
    if (HidesAnything(view.look)) shown = Without(state, view.look);
    const SceneState& scene = shown ? *shown : state;
    drawn_ = ViewsOf(camera, view);
    if (drawn_.size() == 1) {
      DrawnView& only = drawn_.front();
      drawing_->Draw(scene, only.camera, view.look, view.supersample, image, only.labels);
    } else {
      FillWith(image, InksOf(view).separator.color);
      for (DrawnView& each : drawn_) {
        SetSize(part_, each.tile.width, each.tile.height);
        drawing_->Draw(scene, each.camera, view.look, view.supersample, part_, each.labels);
        CopyInto(image, part_, each.tile);
      }
    }
    if (!view.overlays) return;
    Canvas canvas(image);
    overlay_.Paint(canvas, state, drawn_, view);
  }

  // Overlays and all, so that nothing that is drawn or written needs to know about alpha.
  void RenderTransparent(Image& image, const Lifted& lifted) {
    View opaque = lifted.view();
    opaque.look.is_transparent = false;
    opaque.look.background = Rgb{0, 0, 0};
    over_black_.width = image.width;
    over_black_.height = image.height;
    over_black_.rgba.resize(image.rgba.size());
    RenderOpaque(over_black_, lifted.state(), lifted.camera(), opaque);
    opaque.look.background = Rgb{1, 1, 1};
    RenderOpaque(image, lifted.state(), lifted.camera(), opaque);
    MatteOut(image, over_black_);
  }

  std::unique_ptr<Drawing> drawing_;
  Overlay overlay_;
  std::vector<DrawnView> drawn_;  // of the newest picture
  Image part_;                    // one of several views
  Image over_black_;
};

void ToStderr(const std::string& line) { std::fprintf(stderr, "render: %s\n", line.c_str()); }

}  // namespace

Renderer::Renderer() : owner_(std::make_unique<const Owner>()) {}

Renderer::~Renderer() { KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread); }

Image Renderer::Render(const SceneState& state, const Camera& camera, const View& view) {
  Image image;
  RenderInto(image, state, camera, view);
  return image;
}

void Renderer::RenderInto(Image& image, const SceneState& state, const Camera& camera,
                          const View& view) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckView(view);
  SetSize(image, view.width, view.height);
  DoRender(image, state, camera, view);
}

std::string Renderer::OverlayLayer(const SceneState& state, const Camera& camera, const View& view,
                                   LayerFormat format) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckView(view);
  return DoOverlayLayer(state, camera, view, format);
}

std::unique_ptr<Renderer> MakeRenderer(const std::string& backend, LogLine log) {
  if (backend != "osmesa") {
    throw RenderError("back-end '" + backend + "' is not known; there is: osmesa");
  }
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1", 0);
  const auto* module =
      static_cast<const DrawingModule*>(LoadModule("libkinescope_render_osmesa.so", kDrawingEntry));
  return std::make_unique<ModuleRenderer>(module->make(log ? std::move(log) : LogLine(ToStderr)));
}

}  // namespace kinescope::render
