/// What figures and layers of overlays share of Cairo: the fonts, and text that it takes.
#pragma once

#include <string>
#include <string_view>

using cairo_font_face_t =
    struct _cairo_font_face;  // NOLINT(bugprone-reserved-identifier): Cairo's own

namespace kinescope::render::plot {

/// DejaVu Sans, opened once for the process. @throws RenderError where it is missing.
cairo_font_face_t* FontFace(bool is_bold);

/// `text` as UTF-8 that Cairo does not refuse.
std::string Printable(std::string_view text);

/// Cairo numbers its surfaces through the process; the same drawing is to be the same bytes.
std::string WithoutSurfaceNumber(std::string svg);

}  // namespace kinescope::render::plot
