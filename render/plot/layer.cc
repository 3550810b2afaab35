#include "render/plot/layer.h"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "core/system/utf8.h"
#include "render/plot/fonts.h"

namespace kinescope::render::plot {
namespace {

// As CSS has it, so that both formats are equally large.
constexpr double kPxPerInch = 96;

cairo_status_t AppendLayer(void* to, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

// As Cairo has pixels: native-endian ARGB, colours multiplied by alpha.
std::uint32_t CairoPixel(const std::uint8_t* rgba) {
  const std::uint32_t alpha = rgba[3];
  const auto multiplied = [&](std::uint32_t value) { return (value * alpha + 127) / 255; };
  return alpha << 24 | multiplied(rgba[0]) << 16 | multiplied(rgba[1]) << 8 | multiplied(rgba[2]);
}

void PaintPixels(cairo_t* context, int x, int y, const Image& image) {
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, image.height);
  unsigned char* const to = cairo_image_surface_get_data(surface);
  if (to != nullptr) {
    cairo_surface_flush(surface);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < image.rgba.size() / 4; ++i) {
      const std::uint32_t pixel = CairoPixel(&image.rgba[4 * i]);
      std::memcpy(to + i / width * stride + 4 * (i % width), &pixel, sizeof pixel);
    }
    cairo_surface_mark_dirty(surface);
  }
  cairo_set_source_surface(context, surface, x, y);  // the context keeps an error of the surface
  cairo_paint(context);
  cairo_surface_destroy(surface);
}

class CairoLayer : public LayerPainter {
 public:
  CairoLayer(int width_px, int height_px, double width_mm, LayerFormat format, const Image* below)
      : format_(format) {
    const bool is_pdf = format != LayerFormat::kSvg;
    const bool is_printed = width_mm > 0;
    const double px_per_inch = is_printed ? width_px / width_mm * kMmPerInch : kPxPerInch;
    const double units_per_inch = is_pdf ? kPointsPerInch : is_printed ? kMmPerInch : kPxPerInch;
    const double units_per_px = units_per_inch / px_per_inch;
    const double width = units_per_px * width_px, height = units_per_px * height_px;
    if (is_pdf) {
      surface_ = cairo_pdf_surface_create_for_stream(&AppendLayer, &bytes_, width, height);
      // Otherwise the time of day: the same picture is to be the same bytes.
      cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_CREATE_DATE,
                                     "1970-01-01T00:00:00Z");
    } else {
      surface_ = cairo_svg_surface_create_for_stream(&AppendLayer, &bytes_, width, height);
      cairo_svg_surface_set_document_unit(surface_,
                                          is_printed ? CAIRO_SVG_UNIT_MM : CAIRO_SVG_UNIT_PX);
    }
    context_ = cairo_create(surface_);
    if (units_per_px != 1) cairo_scale(context_, units_per_px, units_per_px);
    if (below != nullptr) PaintPixels(context_, 0, 0, *below);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_set_font_options(context_, options);
    cairo_font_options_destroy(options);
    cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context_, CAIRO_LINE_CAP_ROUND);
    cairo_save(context_);
  }
  ~CairoLayer() override {
    cairo_destroy(context_);
    cairo_surface_destroy(surface_);
  }
  CairoLayer(const CairoLayer&) = delete;
  CairoLayer& operator=(const CairoLayer&) = delete;

  void Enter(const Tile& part) override {
    cairo_restore(context_);
    cairo_save(context_);
    cairo_rectangle(context_, part.x, part.y, part.width, part.height);
    cairo_clip(context_);
    cairo_translate(context_, part.x, part.y);
  }

  void RoundedBox(double x, double y, double width, double height, double radius,
                  const Ink& ink) override {
    Use(ink);
    if (radius > 0) {
      cairo_new_sub_path(context_);
      const double left = x + radius, right = x + width - radius;
      const double top = y + radius, bottom = y + height - radius;
      cairo_arc(context_, right, top, radius, -M_PI / 2, 0);
      cairo_arc(context_, right, bottom, radius, 0, M_PI / 2);
      cairo_arc(context_, left, bottom, radius, M_PI / 2, M_PI);
      cairo_arc(context_, left, top, radius, M_PI, 1.5 * M_PI);
      cairo_close_path(context_);
    } else {
      cairo_rectangle(context_, x, y, width, height);
    }
    cairo_fill(context_);
  }

  void Disc(double x, double y, double radius, const Ink& ink) override {
    Use(ink);
    cairo_arc(context_, x, y, radius, 0, 2 * M_PI);
    cairo_fill(context_);
  }

  void Ring(double x, double y, double inner_radius, double outer_radius, const Ink& ink) override {
    Use(ink);
    cairo_set_line_width(context_, outer_radius - inner_radius);
    cairo_arc(context_, x, y, (inner_radius + outer_radius) / 2, 0, 2 * M_PI);
    cairo_stroke(context_);
  }

  void Polyline(const std::vector<std::pair<double, double>>& points, double width,
                const Ink& ink) override {
    if (points.empty()) return;
    Use(ink);
    cairo_set_line_width(context_, width);
    cairo_move_to(context_, points[0].first, points[0].second);
    for (const auto& [x, y] : points) cairo_line_to(context_, x, y);
    cairo_stroke(context_);
  }

  void Picture(int x, int y, const Image& pixels) override { PaintPixels(context_, x, y, pixels); }

  // Advances are those of `font`, by which the page was laid out.
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink& ink) override {
    Use(ink);
    const bool is_bold = font.file_name().find("Bold") != std::string::npos;
    cairo_set_font_face(context_, FontFace(is_bold));
    cairo_set_font_size(context_, size_px);
    cairo_move_to(context_, x, y);
    cairo_show_text(context_, PrintableLine(utf8).c_str());
    return x + font.Width(utf8, size_px);
  }

  std::string Finish() override {
    cairo_restore(context_);
    cairo_surface_finish(surface_);
    for (const cairo_status_t status : {cairo_status(context_), cairo_surface_status(surface_)}) {
      if (status == CAIRO_STATUS_SUCCESS) continue;
      throw RenderError(std::string("cannot draw the overlay: ") + cairo_status_to_string(status));
    }
    return format_ == LayerFormat::kSvg ? WithoutSurfaceNumber(std::move(bytes_))
                                        : std::move(bytes_);
  }

 private:
  void Use(const Ink& ink) {
    cairo_new_path(context_);  // text leaves a point behind, from which an arc would start
    cairo_set_source_rgba(context_, ink.color[0], ink.color[1], ink.color[2], ink.alpha);
  }

  const LayerFormat format_;
  std::string bytes_;  // grow while the surface is finished
  cairo_surface_t* surface_ = nullptr;
  cairo_t* context_ = nullptr;
};

}  // namespace

std::unique_ptr<LayerPainter> MakeLayer(int width_px, int height_px, double width_mm,
                                        LayerFormat format, const Image* below) {
  return std::make_unique<CairoLayer>(width_px, height_px, width_mm, format, below);
}

}  // namespace kinescope::render::plot
