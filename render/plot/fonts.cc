#include "render/plot/fonts.h"

#include <cairo/cairo-ft.h>
#include <cairo/cairo.h>

#include "render/font.h"
#include "render/renderer.h"

namespace kinescope::render::plot {
namespace {

// Opened once and never closed: Cairo keeps scaled fonts, and with them the faces, for later.
class Fonts {
 public:
  static cairo_font_face_t* Get(bool is_bold) {
    static const Fonts* const fonts = new Fonts();
    return fonts->faces_[is_bold ? 1 : 0];
  }

 private:
  Fonts() {
    if (FT_Init_FreeType(&library_) != 0) throw RenderError("FreeType does not start");
    const char* const names[] = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"};
    for (int i = 0; i < 2; ++i) {
      const std::string path = std::string(KINESCOPE_FONT_FOLDER) + "/" + names[i];
      FT_Face file = nullptr;
      if (FT_New_Face(library_, path.c_str(), 0, &file) != 0) {
        throw RenderError("cannot open the font " + path + "; install Debian's fonts-dejavu-core");
      }
      faces_[i] = cairo_ft_font_face_create_for_ft_face(file, FT_LOAD_NO_HINTING);
    }
  }

  FT_Library library_ = nullptr;
  cairo_font_face_t* faces_[2] = {};
};

}  // namespace

cairo_font_face_t* FontFace(bool is_bold) { return Fonts::Get(is_bold); }

std::string WithoutSurfaceNumber(std::string svg) {
  const std::string counted = "<g id=\"surface";
  if (const std::size_t at = svg.find(counted); at != std::string::npos) {
    const std::size_t digits = at + counted.size();
    svg.erase(digits, svg.find('"', digits) - digits);
  }
  return svg;
}

}  // namespace kinescope::render::plot
