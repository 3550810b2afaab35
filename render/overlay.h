/// Paints the overlays of a picture: title, status indicator, legend, time code, banners, names,
/// scale bar, plot, pictures of cameras and frame code. Sizes are in proportion to the picture's
/// height, so that a clip looks the same at any size; text is never smaller than readable. An
/// Overlay belongs to one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/label_layout.h"
#include "render/module.h"
#include "render/overlay_images.h"
#include "render/overlay_page.h"
#include "render/painter.h"
#include "render/renderer.h"

namespace kinescope::render {

class Backdrop;  // render/overlay_backdrop.h

/// One rendered view of the scene within a picture.
struct DrawnView {
  Tile tile;
  Camera camera;
  std::string name;                                  // "" if it is the only view
  DrawnScene painted;                                // over the drawing
  std::shared_ptr<const PaneScene> scene = nullptr;  // of this view; nullptr: the picture's
};

class Overlay {
 public:
  /// Draws the scene of a picture over the pixels of an image, as its camera sees it.
  using DrawScene = std::function<void(const SceneState& state, const ImageCamera& camera,
                                       const PictureSpec& spec, Image& pixels)>;

  /// @param draw_scene  null: images of cameras are painted without the scene
  explicit Overlay(DrawScene draw_scene = nullptr) : draw_scene_(std::move(draw_scene)) {}

  /// Paints on a picture with the size of `spec`. @throws RenderError if a font is missing.
  void Paint(Painter& painter, const SceneState& state, const std::vector<DrawnView>& drawn,
             const PictureSpec& spec);

  /// The texts of markers and frames alone. @throws RenderError as above
  void PaintMarkerTexts(Painter& painter, const std::vector<DrawnView>& drawn,
                        const PictureSpec& spec);

 private:
  using Page = OverlayPage;
  OverlayFonts& fonts();  // opened when first needed

  void PaintView(Page& page, const SceneState& state, const DrawnView& drawn,
                 const PictureSpec& spec, const Backdrop& backdrop, bool has_time_code);
  // Title and status, over the whole picture.
  void PaintHead(Page& page, const SceneState& state, const PictureSpec& spec,
                 const Backdrop& backdrop);
  // What is over the scene, in all views.
  void PaintAround(Page& page, const SceneState& state, const PictureSpec& spec,
                   const Backdrop& backdrop);
  void PaintLamp(Page& page, const SceneState& state);
  void PaintTitle(Page& page, const SceneState& state, const PictureSpec& spec);
  void PaintMarks(Page& page, const SceneState& state, const PictureSpec& spec);
  void PaintTimeCode(Page& page, const SceneState& state);
  void PaintBanner(Page& page, const std::string& full, const std::string& brief);
  void PaintNoData(Page& page, const SceneState& state);
  void PaintNames(Page& page, const SceneState& state, const Camera& camera, bool has_names,
                  const std::vector<Label>& labels);
  void PaintLeader(Page& page, double x, double y, const LabelBox& box, const LabelPlace& place);
  void PaintMarkerTextsOf(Page& page, const DrawnView& drawn, const Backdrop& backdrop);
  void PaintMarkerText(Page& page, const Label& label, const Projected& at, const Rgb& behind);

  const DrawScene draw_scene_;
  std::unique_ptr<OverlayFonts> fonts_;
  OverlayImages images_;
};

/// "hh:mm:ss.mmm"; negative times start with "-".
std::string TimeCode(std::int64_t millis);

}  // namespace kinescope::render
