/// Chooses the colours of texts that have no panel of their own by what is behind them: the floor
/// or the background. Internal to overlay*.cc.
#pragma once

#include <vector>

#include "core/palette.h"
#include "render/overlay.h"
#include "render/overlay_page.h"
#include "render/renderer.h"

namespace kinescope::render {

/// For texts directly on `behind`. A transparent picture and one with the background of its theme
/// have the colours of the theme everywhere.
const Inks& InksOn(const Rgb& behind, const PictureSpec& spec);

/// Of a colour, 0 to 1.
double Lightness(const Rgb& color);

class Backdrop {
 public:
  /// Both are borrowed. `views`: whose floor is at z = 0.
  Backdrop(const PictureSpec& spec, const std::vector<DrawnView>& views)
      : spec_(spec), views_(views) {}

  /// What is at `x`, `y`, px of the picture, behind all that is drawn: the background or the floor.
  Rgb ColorAt(double x, double y) const;
  /// For a text whose middle is there.
  const Inks& InksAt(double x, double y) const;
  /// For texts beside the scene.
  const Inks& InksBesideScene() const;

 private:
  const PictureSpec& spec_;
  const std::vector<DrawnView>& views_;
};

}  // namespace kinescope::render
