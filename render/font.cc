#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

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

Font::Font(const std::string& file_name) : file_name_(file_name), face_(std::make_unique<Face>()) {
  const std::string path = std::string(KINESCOPE_FONT_FOLDER) + "/" + file_name;
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

std::u32string DecodeUtf8(std::string_view utf8) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::u32string decoded;
  for (std::size_t at = 0; at < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[at++]);
    const int more = lead < 0x80   ? 0
                     : lead < 0xC2 ? -1
                     : lead < 0xE0 ? 1
                     : lead < 0xF0 ? 2
                     : lead < 0xF5 ? 3
                                   : -1;
    if (more < 0) {
      decoded += kReplacement;
      continue;
    }
    char32_t value = more == 0 ? lead : lead & (0x3F >> more);
    int taken = 0;
    while (taken < more && at < utf8.size() &&
           (static_cast<unsigned char>(utf8[at]) & 0xC0) == 0x80) {
      value = (value << 6) | (static_cast<unsigned char>(utf8[at++]) & 0x3F);
      ++taken;
    }
    const bool is_overlong = (more == 2 && value < 0x800) || (more == 3 && value < 0x10000);
    const bool is_control = value < 0x20 || (value >= 0x7F && value < 0xA0);
    const bool is_surrogate = value >= 0xD800 && value < 0xE000;
    const bool is_good =
        taken == more && !is_overlong && !is_control && !is_surrogate && value < 0x110000;
    decoded += is_good ? value : kReplacement;
  }
  return decoded;
}

}  // namespace kinescope::render
