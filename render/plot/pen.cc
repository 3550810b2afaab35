#include "render/plot/pen.h"

#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>

#include <cmath>

#include "core/system/check.h"
#include "core/system/utf8.h"
#include "render/plot/fonts.h"
#include "render/renderer.h"

namespace kinescope::render::plot {
namespace {

constexpr Rgb kHatchGround = {0.925, 0.93, 0.94}, kHatchLine = {0.66, 0.68, 0.71};

cairo_status_t AppendSvg(void* to, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct Pen::Parts {
  double width = 0, height = 0;  // pt
  std::string svg;               // grows while the surface is finished
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;
  ~Parts() {
    if (context != nullptr) cairo_destroy(context);
    if (surface != nullptr) cairo_surface_destroy(surface);
  }

  void Begin() {
    context = cairo_create(surface);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(context, options);
    cairo_font_options_destroy(options);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_source_rgb(context, 1, 1, 1);
    cairo_paint(context);
  }

  void Finish() {
    cairo_surface_flush(surface);
    if (const cairo_status_t status = cairo_status(context); status != CAIRO_STATUS_SUCCESS) {
      throw RenderError(std::string("cannot draw the plot: ") + cairo_status_to_string(status));
    }
  }
};

Pen::Pen(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) { parts_->Begin(); }
Pen::~Pen() = default;

std::unique_ptr<Pen> Pen::ForSvg(double width, double height) {
  auto parts = std::make_unique<Parts>();
  parts->width = width;
  parts->height = height;
  parts->surface = cairo_svg_surface_create_for_stream(&AppendSvg, &parts->svg, width, height);
  return std::unique_ptr<Pen>(new Pen(std::move(parts)));
}

std::unique_ptr<Pen> Pen::ForImage(double width, double height, double px_per_pt) {
  auto parts = std::make_unique<Parts>();
  parts->width = width;
  parts->height = height;
  parts->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                              static_cast<int>(std::lround(width * px_per_pt)),
                                              static_cast<int>(std::lround(height * px_per_pt)));
  cairo_surface_set_device_scale(parts->surface, px_per_pt, px_per_pt);
  return std::unique_ptr<Pen>(new Pen(std::move(parts)));
}

void Pen::Box(double x, double y, double width, double height, const Rgb& color, double alpha) {
  cairo_t* const cr = parts_->context;
  cairo_set_source_rgba(cr, color[0], color[1], color[2], alpha);
  cairo_rectangle(cr, x, y, width, height);
  cairo_fill(cr);
}

void Pen::Disc(double x, double y, double radius, const Rgb& color) {
  cairo_t* const cr = parts_->context;
  cairo_set_source_rgb(cr, color[0], color[1], color[2]);
  cairo_arc(cr, x, y, radius, 0, 2 * M_PI);
  cairo_fill(cr);
}

void Pen::Line(double x1, double y1, double x2, double y2, const Rgb& color, double width,
               const std::vector<double>& dash) {
  Polyline({{x1, y1}, {x2, y2}}, color, width, dash);
}

void Pen::Polyline(const std::vector<std::pair<double, double>>& points, const Rgb& color,
                   double width, const std::vector<double>& dash) {
  cairo_t* const cr = parts_->context;
  cairo_set_source_rgb(cr, color[0], color[1], color[2]);
  cairo_set_line_width(cr, width);
  cairo_set_dash(cr, dash.data(), static_cast<int>(dash.size()), 0);
  // A single point between two breaks is a dot.
  cairo_set_line_cap(cr, dash.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  bool is_down = false;
  for (const auto& [x, y] : points) {
    if (std::isnan(y)) {
      is_down = false;
    } else if (is_down) {
      cairo_line_to(cr, x, y);
    } else {
      cairo_move_to(cr, x, y);
      cairo_line_to(cr, x, y);
      is_down = true;
    }
  }
  cairo_stroke(cr);
  cairo_set_dash(cr, nullptr, 0, 0);
}

void Pen::Hatch(double x, double y, double width, double height) {
  Box(x, y, width, height, kHatchGround);
  Clip(x, y, width, height);
  constexpr double kApart = 4;
  // On one grid for the whole plot, so that neighbours join.
  const int first = static_cast<int>(std::floor((x - height) / kApart));
  for (int i = first; i * kApart < x + width + height; ++i) {
    const double at = i * kApart - std::fmod(y, kApart);
    Line(at, y + height, at + height, y, kHatchLine, 0.6);
  }
  Unclip();
}

void Pen::UseFont(double size, bool is_bold) {
  cairo_set_font_face(parts_->context, FontFace(is_bold));
  cairo_set_font_size(parts_->context, size);
}

double Pen::TextWidth(const std::string& text, double size, bool is_bold) {
  UseFont(size, is_bold);
  cairo_text_extents_t extents;
  cairo_text_extents(parts_->context, PrintableLine(text).c_str(), &extents);
  return extents.x_advance;
}

void Pen::Text(double x, double y, const std::string& text, double size, const Rgb& color,
               Anchor anchor, bool is_bold, bool is_upright) {
  cairo_t* const cr = parts_->context;
  const double width = TextWidth(text, size, is_bold);
  const double back = anchor == Anchor::kLeft ? 0 : anchor == Anchor::kMiddle ? width / 2 : width;
  cairo_save(cr);
  cairo_set_source_rgb(cr, color[0], color[1], color[2]);
  cairo_translate(cr, x, y);
  if (is_upright) cairo_rotate(cr, -M_PI / 2);
  cairo_move_to(cr, -back, 0);
  cairo_show_text(cr, PrintableLine(text).c_str());
  cairo_restore(cr);
}

void Pen::Clip(double x, double y, double width, double height) {
  cairo_save(parts_->context);
  cairo_rectangle(parts_->context, x, y, width, height);
  cairo_clip(parts_->context);
}

void Pen::Unclip() { cairo_restore(parts_->context); }

std::string Pen::TakeSvg() {
  parts_->Finish();
  cairo_surface_finish(parts_->surface);
  return WithoutSurfaceNumber(std::move(parts_->svg));
}

Image Pen::TakeImage() {
  parts_->Finish();
  const int width = cairo_image_surface_get_width(parts_->surface);
  const int height = cairo_image_surface_get_height(parts_->surface);
  const int stride = cairo_image_surface_get_stride(parts_->surface);
  const unsigned char* const data = cairo_image_surface_get_data(parts_->surface);
  KINESCOPE_CHECK(data != nullptr && width > 0 && height > 0);
  Image image;
  image.width = width;
  image.height = height;
  image.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::size_t to = 0;
  for (int row = 0; row < height; ++row) {
    const auto* from =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < width; ++column, to += 4) {  // 0x00RRGGBB, native order
      image.rgba[to] = static_cast<std::uint8_t>(from[column] >> 16);
      image.rgba[to + 1] = static_cast<std::uint8_t>(from[column] >> 8);
      image.rgba[to + 2] = static_cast<std::uint8_t>(from[column]);
      image.rgba[to + 3] = 255;
    }
  }
  return image;
}

}  // namespace kinescope::render::plot
