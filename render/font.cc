#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include "core/system/utf8.h"
#include "render/renderer.h"

namespace kinescope::render {

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  int size_px = 0;
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
};

std::filesystem::path FontPath(const std::string& file_name) {
  return std::filesystem::path(KINESCOPE_FONT_FOLDER) / file_name;
}

Font::Font(const std::string& file_name) : file_name_(file_name), face_(std::make_unique<Face>()) {
  const std::string path = FontPath(file_name);
  if (FT_Init_FreeType(&face_->library) != 0 ||
      FT_New_Face(face_->library, path.c_str(), 0, &face_->face) != 0) {
    throw RenderError("cannot open the font " + path + "; install Debian's fonts-dejavu-core");
  }
}

Font::~Font() = default;

const Glyph& Font::Get(char32_t code_point, int size_px) {
  const auto key = std::make_pair(size_px, code_point);
  if (const auto known = glyphs_.find(key); known != glyphs_.end()) return known->second;
  if (face_->size_px != size_px) {
    FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(size_px));
    face_->size_px = size_px;
  }
  Glyph glyph;
  if (FT_Load_Char(face_->face, code_point, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) == 0) {
    const FT_GlyphSlot slot = face_->face->glyph;
    glyph.left = slot->bitmap_left;
    glyph.top = slot->bitmap_top;
    glyph.width = static_cast<int>(slot->bitmap.width);
    glyph.height = static_cast<int>(slot->bitmap.rows);
    glyph.advance = static_cast<double>(slot->linearHoriAdvance) / 65536;
    for (int row = 0; row < glyph.height; ++row) {
      const std::uint8_t* from = slot->bitmap.buffer + row * slot->bitmap.pitch;
      glyph.coverage.insert(glyph.coverage.end(), from, from + glyph.width);
    }
  }
  // Names come from outside: a sender that goes through all of Unicode must not fill the memory.
  if (glyphs_.size() > 4096) glyphs_.clear();
  return glyphs_.emplace(key, std::move(glyph)).first->second;
}

double Font::Width(std::string_view utf8, int size_px) {
  double width = 0;
  for (const char32_t code_point : DecodeUtf8(utf8)) width += Get(code_point, size_px).advance;
  return width;
}

}  // namespace kinescope::render
