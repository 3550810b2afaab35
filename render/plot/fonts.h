/// Common Cairo parts of plots and overlay layers: the fonts.
#pragma once

#include <string>
#include <string_view>

using cairo_font_face_t =
    struct _cairo_font_face;  // NOLINT(bugprone-reserved-identifier): Cairo's own

namespace kinescope::render::plot {

/// DejaVu Sans, opened once per process. @throws RenderError if it is missing.
cairo_font_face_t* FontFace(bool is_bold);

/// Removes the numbers that Cairo gives to surfaces in a process, so that equal drawings give equal
/// bytes.
std::string WithoutSurfaceNumber(std::string svg);

}  // namespace kinescope::render::plot
