/// Rasterises text as coverage: glyphs of one typeface, made once by FreeType and kept. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinescope::render {

struct Glyph {
  int left = 0, top = 0;  // px, of the bitmap's corner from pen position and baseline; top is
                          // positive upwards
  int width = 0, height = 0;
  double advance = 0;                  // px
  std::vector<std::uint8_t> coverage;  // (height, width)
};

/// Where the font of this file name is. Whether it is there is not looked at.
std::filesystem::path FontPath(const std::string& file_name);

class Font {
 public:
  /// `file_name` such as "DejaVuSans.ttf". @throws RenderError with the Debian package that
  /// contains it.
  explicit Font(const std::string& file_name);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// @pre size_px >= 1
  const Glyph& Get(char32_t code_point, int size_px);

  /// Width of `utf8` on one line, px.
  double Width(std::string_view utf8, int size_px);

  const std::string& file_name() const { return file_name_; }

 private:
  struct Face;
  std::string file_name_;
  std::unique_ptr<Face> face_;
  std::map<std::pair<int, char32_t>, Glyph> glyphs_;  // by size and code point
};

}  // namespace kinescope::render
