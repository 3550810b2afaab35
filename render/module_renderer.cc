#include "render/module_renderer.h"

#include <utility>

#include "core/system/check.h"
#include "render/canvas.h"
#include "render/finite.h"
#include "render/floor_lift.h"
#include "render/image/matte.h"
#include "render/multi_view.h"

namespace kinescope::render {
namespace {

std::string TookTooLong(const std::string& what, std::chrono::milliseconds limit) {
  return what + " has taken more than " + std::to_string(limit.count()) +
         " ms: the OpenGL driver does not respond; try another --backend, or raise "
         "--draw_limit_secs if the machine is slow";
}

// The picture's arguments raised so that the floor is at z = 0, where the drawing has it.
class Lifted {
 public:
  Lifted(const SceneState& state, const Camera& camera, const PictureSpec& spec)
      : state_(state), camera_(camera), spec_(spec) {
    if (IsLifted(state, spec)) return;
    raised_.emplace(Raised{state, camera, spec});
    LiftToFloor(raised_->state, raised_->camera, raised_->spec);
  }

  const SceneState& state() const { return raised_ ? raised_->state : state_; }
  const Camera& camera() const { return raised_ ? raised_->camera : camera_; }
  const PictureSpec& spec() const { return raised_ ? raised_->spec : spec_; }

 private:
  struct Raised {
    SceneState state;
    Camera camera;
    PictureSpec spec;
  };
  const SceneState& state_;
  const Camera& camera_;
  const PictureSpec& spec_;
  std::optional<Raised> raised_;
};

std::vector<DrawnView> ViewsOf(const Camera& camera, const PictureSpec& spec) {
  if (spec.panes.empty()) return {{spec.SceneTile(), camera, "", {}}};
  const auto tiles =
      PaneTiles(spec.SceneTile(), static_cast<int>(spec.panes.size()), spec.pane_columns);
  std::vector<DrawnView> views;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Pane& pane = spec.panes[i];
    views.push_back({tiles[i], pane.camera, pane.name, {}, pane.scene});
  }
  return views;
}

void PaintLinesOf(Painter& painter, const std::vector<DrawnView>& views, const PictureSpec& spec) {
  for (const DrawnView& view : views) {
    painter.Enter(view.tile);
    PaintLines(painter, view.painted.lines, spec);
  }
  painter.Enter({0, 0, spec.width, spec.height});
}

}  // namespace

ModuleRenderer::ModuleRenderer(const DrawingModule& module, RendererSettings settings)
    : settings_(std::move(settings)),
      watchdog_(settings_.on_hang ? settings_.on_hang : Watchdog::OnHang(EndProcess)) {
  const Watchdog::Work work(watchdog_, LimitOf(PictureSpec()), [this] {
    return TookTooLong("starting back-end " + settings_.backend, LimitOf(PictureSpec()));
  });
  drawing_ = module.make(settings_.backend, settings_.log, settings_.regions);
}

RendererInfo ModuleRenderer::info() const {
  const Driver driver = drawing_->driver();
  return {settings_.backend, driver.renderer, driver.gl_version, IsSoftware(driver.renderer),
          settings_.note};
}

std::vector<std::string> ModuleRenderer::problems() const {
  std::vector<std::string> all = skipped_;
  for (std::string& problem : drawing_->problems()) all.push_back(std::move(problem));
  return all;
}

std::chrono::milliseconds ModuleRenderer::LimitOfPicture(const PictureSpec& spec) const {
  return settings_.limit.count() > 0 ? settings_.limit : LimitOf(spec);
}

ModuleRenderer::Finite::Finite(const SceneState& given_state, const PictureSpec& given_spec,
                               std::vector<std::string>& skipped)
    : given_state_(given_state),
      given_spec_(given_spec),
      kept_state_(WithoutNonFinite(given_state, skipped)) {
  for (std::size_t i = 0; i < given_spec.panes.size(); ++i) {
    const auto& scene = given_spec.panes[i].scene;
    if (scene == nullptr) continue;
    auto kept = WithoutNonFinite(scene->state, skipped);
    if (!kept) continue;
    if (!kept_spec_) kept_spec_ = given_spec;
    kept_spec_->panes[i].scene = std::make_shared<const PaneScene>(
        PaneScene{std::move(*kept), scene->trails, scene->ghosts});
  }
}

ModuleRenderer::Finite ModuleRenderer::Drawable(const SceneState& state, const PictureSpec& spec) {
  skipped_.clear();
  Finite finite(state, spec, skipped_);
  for (const std::string& line : skipped_) {
    if (said_.insert(line).second) settings_.log(line);
  }
  return finite;
}

void ModuleRenderer::DoRender(Image& image, const SceneState& state, const Camera& camera,
                              const PictureSpec& spec) {
  const Finite finite = Drawable(state, spec);
  const Lifted lifted(finite.state(), camera, finite.spec());
  if (lifted.spec().look.is_transparent) {
    RenderTransparent(image, lifted.state(), lifted.camera(), lifted.spec());
  } else {
    RenderOpaque(image, lifted.state(), lifted.camera(), lifted.spec());
  }
}

std::string ModuleRenderer::DoOverlayLayer(const SceneState& state, const Camera& camera,
                                           const PictureSpec& spec, LayerFormat format) {
  const Finite finite = Drawable(state, spec);
  const Lifted lifted(finite.state(), camera, finite.spec());
  if (format == LayerFormat::kPdfPage) {
    PictureSpec below = spec;
    below.overlays = below.lines = false;
    SetSize(below_layer_, spec.width, spec.height);
    DoRender(below_layer_, state, camera, below);
  }
  std::vector<DrawnView> views = ViewsOf(lifted.camera(), lifted.spec());
  KINESCOPE_CHECK(views.size() == drawn_.size());  // of the picture drawn last
  for (std::size_t i = 0; i < views.size(); ++i) views[i].painted = drawn_[i].painted;
  const auto painter = MakeLayerPainter(spec.width, spec.height, spec.print.width_mm, format,
                                        format == LayerFormat::kPdfPage ? &below_layer_ : nullptr);
  PaintLinesOf(*painter, views, lifted.spec());
  overlay_.Paint(*painter, lifted.state(), views, lifted.spec());
  return painter->Finish();
}

void ModuleRenderer::DrawWatched(const SceneState& state, DrawnView& drawn, const PictureSpec& spec,
                                 const SceneLook& look, Image& image) {
  const Watchdog::Work work(watchdog_, LimitOfPicture(spec), [this, &spec] {
    return TookTooLong("a picture of " + std::to_string(spec.width) + " x " +
                           std::to_string(spec.height) + " px by back-end " + settings_.backend,
                       LimitOfPicture(spec));
  });
  drawing_->Draw(state, drawn.camera, look, spec.supersample, image, drawn.painted);
}

void ModuleRenderer::DrawView(const SceneState& state, DrawnView& drawn, const PictureSpec& spec,
                              Image& image) {
  if (drawn.scene == nullptr) return DrawWatched(state, drawn, spec, spec.look, image);
  SceneLook look = spec.look;
  look.trails = drawn.scene->trails;
  look.ghosts = drawn.scene->ghosts;
  DrawWatched(HidesAnything(look) ? Without(drawn.scene->state, look) : drawn.scene->state, drawn,
              spec, look, image);
}

void ModuleRenderer::RenderOpaque(Image& image, const SceneState& state, const Camera& camera,
                                  const PictureSpec& spec) {
  std::optional<SceneState> shown;
  if (HidesAnything(spec.look)) shown = Without(state, spec.look);
  const SceneState& scene = shown ? *shown : state;
  drawn_ = ViewsOf(camera, spec);
  if (drawn_.size() == 1 && !spec.scene) {
    DrawView(scene, drawn_.front(), spec, image);
  } else {
    FillWith(image, {0, 0, image.width, image.height}, BackgroundOf(spec.look));
    if (drawn_.size() > 1) FillWith(image, spec.SceneTile(), InksOf(spec).separator.color);
    for (DrawnView& each : drawn_) {
      SetSize(part_, each.tile.width, each.tile.height);
      DrawView(scene, each, spec, part_);
      CopyInto(image, part_, each.tile);
    }
  }
  Canvas canvas(image);
  if (spec.lines) PaintLinesOf(canvas, drawn_, spec);
  if (!spec.overlays) return;
  overlay_.Paint(canvas, state, drawn_, spec);
}

// Overlays and all, so that nothing that is drawn or written needs to know about alpha.
void ModuleRenderer::RenderTransparent(Image& image, const SceneState& state, const Camera& camera,
                                       const PictureSpec& spec) {
  PictureSpec opaque = spec;
  opaque.look.is_transparent = false;
  opaque.look.background = Rgb{0, 0, 0};
  SetSize(over_black_, image.width, image.height);
  RenderOpaque(over_black_, state, camera, opaque);
  opaque.look.background = Rgb{1, 1, 1};
  RenderOpaque(image, state, camera, opaque);
  MatteOut(image, over_black_);
}

}  // namespace kinescope::render
