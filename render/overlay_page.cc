#include "render/overlay_page.h"

#include "render/frame_code.h"

namespace kinescope::render {
namespace {

constexpr double kSpreadInPrint = 0.35;  // a title is a quarter larger than the legend there

// Of the sizes for a picture that is 720 px high.
double ScaleOf(const PictureSpec& spec) {
  if (!spec.print.is_known()) {
    return std::max(0.5, std::min(spec.height / 720.0, spec.width / 1000.0));
  }
  // Whole pixels, as fonts have them.
  return std::ceil(spec.print.text_pt * spec.print.PixelsPerPoint(spec.width) - 1e-6) / kSmallSize;
}

// Whether the texts of a legend or a title would cover the people.
bool IsSmall(const PictureSpec& spec, double scale) {
  if (!spec.print.is_known()) return spec.width < 300 || spec.height < 160;
  const double text = scale * kSmallSize;
  return spec.width < 24 * text || spec.height < 12 * text;
}

}  // namespace

bool HasRoomForTexts(const PictureSpec& spec) { return !IsSmall(spec, ScaleOf(spec)); }

OverlaySizes SizesOf(const PictureSpec& spec, OverlayFonts& fonts) {
  const double scale = ScaleOf(spec);
  const double frame_code =
      spec.parts.frame_code ? FrameCodeLayoutOf(spec.width, spec.height).height() : 0;
  return {fonts,
          static_cast<double>(spec.width),
          static_cast<double>(spec.height),
          scale,
          spec.height - frame_code,
          IsSmall(spec, scale),
          spec.print.is_known() ? kSpreadInPrint : 1.0};
}

OverlaySizes SizesOfScene(const PictureSpec& spec, OverlayFonts& fonts) {
  OverlaySizes sizes = SizesOf(spec, fonts);
  const Tile scene = spec.SceneTile();
  sizes.width = scene.width;
  sizes.height = scene.height;
  sizes.bottom = std::min(sizes.height, sizes.bottom - scene.y);
  return sizes;
}

std::string Shorten(const std::string& text, Font& font, int size_px, double width) {
  const double room = width - font.Width("…", size_px);
  double used = 0;
  std::size_t fits = 0;  // bytes, together with an ellipsis
  for (std::size_t at = 0; at < text.size();) {
    std::size_t next = at + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xC0) == 0x80) ++next;
    used += font.Width(std::string_view(text).substr(at, next - at), size_px);
    if (used > width) return fits > 0 ? text.substr(0, fits) + "…" : "";
    if (used <= room) fits = next;
    at = next;
  }
  return text;
}

}  // namespace kinescope::render
