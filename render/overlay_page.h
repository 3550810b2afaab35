/// Common parts of the overlay painters: the picture being painted, its colours and sizes. Internal
/// to overlay*.cc.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "render/font.h"
#include "render/painter.h"
#include "render/renderer.h"

namespace kinescope::render {

/// The colours of overlays, one set per theme.
struct Inks {
  Ink text, faint_text;
  Ink panel;          // behind text over the scene
  Ink rim;            // of the high class's sphere
  Ink banner;         // "STALE"
  Ink on_banner;      // its text
  Ink notice;         // "NO DATA"
  Ink line;           // scale bar, curve
  Ink halo;           // around lines, so that they are visible on any background
  Ink separator;      // between views
  double band_alpha;  // of the class bands behind curves
};

inline constexpr Inks kLightInks = {{{0.13, 0.15, 0.19}, 1},
                                    {{0.38, 0.41, 0.46}, 1},
                                    {{1, 1, 1}, 0.78},
                                    {{0.15, 0.02, 0.02}, 1},
                                    {{0.98, 0.80, 0.35}, 0.95},
                                    {{0.13, 0.15, 0.19}, 1},
                                    {{1, 1, 1}, 0.85},
                                    {{0.13, 0.15, 0.19}, 1},
                                    {{1, 1, 1}, 0.78},
                                    {{0.72, 0.74, 0.77}, 1},
                                    0.22};

inline constexpr Inks kDarkInks = {{{0.93, 0.94, 0.96}, 1},
                                   {{0.68, 0.71, 0.76}, 1},
                                   {{0.09, 0.10, 0.12}, 0.78},
                                   {{0.15, 0.02, 0.02}, 1},
                                   {{0.98, 0.80, 0.35}, 0.95},
                                   {{0.13, 0.15, 0.19}, 1},
                                   {{0.09, 0.10, 0.12}, 0.85},
                                   {{0.93, 0.94, 0.96}, 1},
                                   {{0.09, 0.10, 0.12}, 0.78},
                                   {{0.34, 0.36, 0.40}, 1},
                                   0.30};

inline const Inks& InksOf(const PictureSpec& spec) {
  return spec.look.theme == Theme::kDark ? kDarkInks : kLightInks;
}

// Sizes in px for a picture 720 px high; all scale with the height.
inline constexpr double kMargin = 20, kTitleSize = 22, kTextSize = 15, kSmallSize = 13;
inline constexpr double kTimeCodeLine = 22;  // from the time code's baseline to the sample's

struct OverlayFonts {
  Font regular{"DejaVuSans.ttf"};
  Font bold{"DejaVuSans-Bold.ttf"};
};

/// Coordinates are relative to the corner of the painted area: a picture, or one view of several.
struct OverlaySizes {
  OverlayFonts& fonts;
  double width, height, scale;
  double bottom;      // height minus the frame code at the bottom
  bool is_small;      // room only for a status indicator without text, and banners
  double spread = 1;  // of the sizes of texts: 1 on screens; in print, where all are read, less

  double Px(double at_720) const { return at_720 * scale; }
  int FontPx(double at_720) const {
    const double spread_size = kSmallSize + spread * (at_720 - kSmallSize);
    return std::max(8, static_cast<int>(std::lround(Px(spread_size))));
  }
  /// Of numbers at axes. In print they are as large as the smallest text that was asked for.
  int AxisFontPx() const { return std::max(8, FontPx(kSmallSize) - (spread < 1 ? 0 : 2)); }
  double right() const { return width - Px(kMargin); }
};

/// Of the whole picture.
OverlaySizes SizesOf(const PictureSpec& spec, OverlayFonts& fonts);
/// Of the part that shows the scene, with the texts of the whole picture.
OverlaySizes SizesOfScene(const PictureSpec& spec, OverlayFonts& fonts);

struct OverlayPage : OverlaySizes {
  OverlayPage(const OverlaySizes& sizes, Painter& painter, const Inks& used_inks)
      : OverlaySizes(sizes), canvas(painter), inks(used_inks) {}

  Painter& canvas;
  const Inks& inks;
};

/// `text`, shortened with an ellipsis if necessary. Reads only as much as fits: names are untrusted
/// and may have any length.
std::string Shorten(const std::string& text, Font& font, int size_px, double width);

}  // namespace kinescope::render
