#include "render/module_renderer.h"

#include <utility>

#include "core/system/check.h"
#include "render/camera/image_view.h"
#include "render/canvas.h"
#include "render/finite.h"
#include "render/floor_lift.h"
#include "render/image/matte.h"
#include "render/multi_view.h"
#include "render/text_notes.h"

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

// Calls `use` with the state and the look of a view: the picture's, or its own.
template <class Use>
void WithSceneOf(const DrawnView& view, const SceneState& state, const PictureSpec& spec,
                 const Use& use) {
  if (view.scene == nullptr) return use(state, spec.look);
  SceneLook look = spec.look;
  look.trails = view.scene->trails;
  look.ghosts = view.scene->ghosts;
  use(HidesAnything(look) ? Without(view.scene->state, look) : view.scene->state, look);
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
  return {settings_.backend,           driver.renderer, driver.gl_version,
          IsSoftware(driver.renderer), settings_.note,  driver.scene_library};
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

std::vector<DrawnView> ModuleRenderer::ViewsAsDrawn(const Camera& camera,
                                                    const PictureSpec& spec) const {
  std::vector<DrawnView> views = ViewsOf(camera, spec);
  KINESCOPE_CHECK(views.size() == drawn_.size());
  for (std::size_t i = 0; i < views.size(); ++i) views[i].painted = drawn_[i].painted;
  return views;
}

std::string ModuleRenderer::DoOverlayLayer(const SceneState& state, const Camera& camera,
                                           const PictureSpec& spec, LayerFormat format) {
  const Finite finite = Drawable(state, spec);
  const Lifted lifted(finite.state(), camera, finite.spec());
  if (format == LayerFormat::kPdfPage) {
    PictureSpec below = spec;
    below.overlays = below.marker_texts = below.lines = false;
    SetSize(below_layer_, spec.width, spec.height);
    DoRender(below_layer_, state, camera, below);
  }
  const std::vector<DrawnView> views = ViewsAsDrawn(lifted.camera(), lifted.spec());
  const auto painter = MakeLayerPainter(spec.width, spec.height, spec.print.width_mm, format,
                                        format == LayerFormat::kPdfPage ? &below_layer_ : nullptr);
  PaintLinesOf(*painter, views, lifted.spec());
  PaintOverlays(*painter, lifted.state(), views, lifted.spec());
  return painter->Finish();
}

PictureContents ModuleRenderer::DoContents(const SceneState& state, const Camera& camera,
                                           const PictureSpec& spec) {
  const Finite finite = Drawable(state, spec);
  const Lifted lifted(finite.state(), camera, finite.spec());
  const PictureSpec& used = lifted.spec();
  const std::vector<DrawnView> views = ViewsAsDrawn(lifted.camera(), used);
  PictureContents contents;
  const SceneState shown =
      HidesAnything(used.look) ? Without(lifted.state(), used.look) : lifted.state();
  for (const DrawnView& view : views) SeeView(shown, view, used, contents.objects);
  TextNotes notes;
  PaintOverlays(notes, lifted.state(), views, used);
  contents.texts = notes.Take();
  return contents;
}

void ModuleRenderer::SeeView(const SceneState& state, const DrawnView& drawn,
                             const PictureSpec& spec, std::vector<SeenObject>& objects) {
  const Watchdog::Work work(watchdog_, LimitOfPicture(spec), [this, &spec] {
    return TookTooLong("finding what a picture shows, by back-end " + settings_.backend,
                       LimitOfPicture(spec));
  });
  const Tile& tile = drawn.tile;
  std::vector<SeenObject> seen;
  WithSceneOf(drawn, state, spec, [&](const SceneState& shown, const SceneLook& look) {
    seen = drawing_->See(shown, drawn.camera, look, spec.supersample, tile.width, tile.height);
  });
  for (SeenObject& object : seen) {
    object.view = drawn.name;
    object.x_px += tile.x;
    object.y_px += tile.y;
    object.box.x += tile.x;
    object.box.y += tile.y;
    objects.push_back(std::move(object));
  }
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
  WithSceneOf(drawn, state, spec, [&](const SceneState& shown, const SceneLook& look) {
    DrawWatched(shown, drawn, spec, look, image);
  });
}

void ModuleRenderer::DrawSceneOver(const SceneState& state, const ImageCamera& camera,
                                   const PictureSpec& spec, Image& pixels) {
  const ImageView view = ViewOf(camera, pixels.width, pixels.height);
  PictureSpec bare = spec;  // nothing of what is behind the scene
  bare.look.floor = false;
  bare.look.shown.Set(ScenePart::kShadows, false);
  if (bare.look.style == Style::kLine) bare.look.style = Style::kMatte;
  const SceneState shown = Without(state, bare.look);
  DrawnView drawn{{0, 0, view.width, view.height}, view.camera, "", {}};
  const auto draw_over = [&](const Rgb& background, Image& image) {
    bare.look.background = background;
    SetSize(image, view.width, view.height);
    DrawWatched(shown, drawn, bare, bare.look, image);
  };
  draw_over({0, 0, 0}, on_image_over_black_);
  draw_over({1, 1, 1}, on_image_);
  MatteOut(on_image_, on_image_over_black_);
  LayOver(pixels, on_image_, view.image, camera.scene_opacity);
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
  PaintOverlays(canvas, state, drawn_, spec);
}

void ModuleRenderer::PaintOverlays(Painter& painter, const SceneState& state,
                                   const std::vector<DrawnView>& views, const PictureSpec& spec) {
  if (spec.overlays) return overlay_.Paint(painter, state, views, spec);
  if (spec.marker_texts) overlay_.PaintMarkerTexts(painter, views, spec);
}

// Overlays and all, so that nothing that is drawn or written needs to know about alpha.
void ModuleRenderer::RenderTransparent(Image& image, const SceneState& state, const Camera& camera,
                                       const PictureSpec& spec) {
  PictureSpec opaque = spec;
  opaque.look.background = Rgb{0, 0, 0};
  SetSize(over_black_, image.width, image.height);
  RenderOpaque(over_black_, state, camera, opaque);
  opaque.look.background = Rgb{1, 1, 1};
  RenderOpaque(image, state, camera, opaque);
  MatteOut(image, over_black_);
}

}  // namespace kinescope::render
