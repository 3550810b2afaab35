/// Implements Renderer with a module: removes values that are not finite, shifts the floor to z =
/// 0, adds transparency, several views and overlays, and watches the driver. Belongs to the thread
/// that made it.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render/module.h"
#include "render/overlay.h"
#include "render/renderer.h"
#include "render/watchdog.h"

namespace kinescope::render {

class ModuleRenderer : public Renderer {
 public:
  /// `settings` with a log. @throws RenderError.
  ModuleRenderer(const DrawingModule& module, RendererSettings settings);

  RendererInfo info() const override;
  Eigen::AlignedBox3d Bounds(const RobotState& robot) override { return drawing_->Bounds(robot); }
  std::vector<std::string> problems() const override;

 private:
  void DoRender(Image& image, const SceneState& state, const Camera& camera,
                const PictureSpec& spec) override;
  std::string DoOverlayLayer(const SceneState& state, const Camera& camera, const PictureSpec& spec,
                             LayerFormat format) override;
  PictureContents DoContents(const SceneState& state, const Camera& camera,
                             const PictureSpec& spec) override;

  // Of the picture drawn last.
  std::vector<DrawnView> ViewsAsDrawn(const Camera& camera, const PictureSpec& spec) const;
  void RenderOpaque(Image& image, const SceneState& state, const Camera& camera,
                    const PictureSpec& spec);
  void PaintOverlays(Painter& painter, const SceneState& state, const std::vector<DrawnView>& views,
                     const PictureSpec& spec);
  void RenderTransparent(Image& image, const SceneState& state, const Camera& camera,
                         const PictureSpec& spec);
  void DrawWatched(const SceneState& state, DrawnView& drawn, const PictureSpec& spec,
                   const SceneLook& look, Image& image);
  // Over the pixels of an image that `camera` took.
  void DrawSceneOver(const SceneState& state, const ImageCamera& camera, const PictureSpec& spec,
                     Image& pixels);
  // `state`, unless the view has a scene of its own.
  void DrawView(const SceneState& state, DrawnView& drawn, const PictureSpec& spec, Image& image);
  void SeeView(const SceneState& state, const DrawnView& drawn, const PictureSpec& spec,
               std::vector<SeenObject>& objects);

  // The arguments of a picture, or the part of them that can be rendered.
  class Finite {
   public:
    Finite(const SceneState& given_state, const PictureSpec& given_spec,
           std::vector<std::string>& skipped);
    const SceneState& state() const { return kept_state_ ? *kept_state_ : given_state_; }
    const PictureSpec& spec() const { return kept_spec_ ? *kept_spec_ : given_spec_; }

   private:
    const SceneState& given_state_;
    const PictureSpec& given_spec_;
    std::optional<SceneState> kept_state_;
    std::optional<PictureSpec> kept_spec_;
  };
  Finite Drawable(const SceneState& state, const PictureSpec& spec);
  std::chrono::milliseconds LimitOfPicture(const PictureSpec& spec) const;

  const RendererSettings settings_;
  Watchdog watchdog_;
  std::unique_ptr<Drawing> drawing_;
  Overlay overlay_{[this](const SceneState& state, const ImageCamera& camera,
                          const PictureSpec& spec,
                          Image& pixels) { DrawSceneOver(state, camera, spec, pixels); }};
  std::vector<DrawnView> drawn_;      // of the newest picture
  std::vector<std::string> skipped_;  // of the newest picture
  std::set<std::string> said_;
  Image part_;  // one of several views
  Image over_black_;
  Image on_image_, on_image_over_black_;  // the scene over an image of a camera
  Image below_layer_;
};

}  // namespace kinescope::render
